"""`cratous params`, and the names of ICAROUS: all known, used or not used for a reason, none silently."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from cratous.services.parameters.icarous_names import NAMES
from cratous.services.parameters.mapping import settings_of
from cratous.services.parameters.parameter_file import parse
from cratous.spec.errors import BadInput

Run = Callable[..., tuple[int, str, str]]
ALL = "".join(
    f"{name.name} = {name.default}{f' [{name.unit}]' if name.unit else ''}\n"
    for name in NAMES.values()
)


def test_every_parameter_of_a_mission_says_where_it_comes_from(run: Run, root: Path) -> None:
    mission = root / "examples" / "crossing" / "mission.yaml"
    code, out, _ = run("params", mission, "--json")
    data = json.loads(out)
    assert (code, data["notes"]) == (0, [])
    rows = {(row["name"], row["vehicle"]): row for row in data["parameters"]}
    assert rows["daa.lookahead_s", 0]["origin"] == "given"
    assert rows["daa.buffer", 0] == {
        "name": "daa.buffer", "vehicle": 0, "value": 1.25, "unit": "", "default": 1.25,
        "low": 1, "high": 5, "origin": "default", "how": rows["daa.buffer", 0]["how"],
    }  # fmt: skip
    derived = [row for row in data["parameters"] if row["origin"] == "derived"]
    assert {row["vehicle"] for row in derived} == {1, 2}
    assert all(row["how"] for row in data["parameters"])
    text = run("params", mission)[1]
    assert "g tan(max_bank) / speed" in text
    assert all(name in text for name, _ in rows)


def test_a_speed_that_is_left_out_is_derived(run: Run, root: Path, tmp_path: Path) -> None:
    text = (root / "examples/crossing/mission.yaml").read_text(encoding="utf-8")
    bare = text.replace("    min_speed_m_s: 15\n", "", 1).partition("variation:")[0]
    (tmp_path / "mission.yaml").write_text(bare, encoding="utf-8")
    rows = json.loads(run("params", tmp_path, "--json")[1])["parameters"]
    mine = [row for row in rows if row["name"] == "min_speed_m_s"]
    assert [row["origin"] for row in mine] == ["derived", "given"]
    assert mine[0]["value"] == 22


def test_what_is_sensed_has_parameters_too(run: Run, root: Path) -> None:
    rows = json.loads(run("params", root / "examples/sensed", "--json")[1])["parameters"]
    found = {row["name"]: row for row in rows if row["name"].startswith("sensing.")}
    assert found["sensing.sigmas"]["low"] == 1
    assert {row["origin"] for row in found.values()} == {"given", "default"}
    assert any("(adsb)" in name or "(radar)" in name for name in found)
    plain = json.loads(run("params", root / "examples/crossing", "--json")[1])["parameters"]
    assert not [row for row in plain if row["name"].startswith("sensing.")]


def test_what_does_not_fit_is_said(run: Run, root: Path, tmp_path: Path) -> None:
    text = (root / "examples/crossing/mission.yaml").read_text(encoding="utf-8")
    short = text.replace("lookahead_s: 60", "lookahead_s: 3").partition("variation:")[0]
    (tmp_path / "mission.yaml").write_text(short, encoding="utf-8")
    assert "note: parameter does not fit: daa.lookahead_s is 3 s" in run("params", tmp_path)[1]
    assert "does not fit: daa.lookahead_s" in run("check", tmp_path / "mission.yaml")[1]


def test_the_names_are_those_of_icarous(shared: Path) -> None:
    file = shared / "vectors" / "icarous" / "icarous-parameters.json"
    listed = json.loads(file.read_text(encoding="utf-8"))
    theirs = {(one["name"], one["default"], one["unit"] or "") for one in listed}
    assert theirs == {(name.name, name.default, name.unit) for name in NAMES.values()}


def test_the_page_has_every_name(root: Path) -> None:
    page = (root / "docs/reference/parameters.md").read_text(encoding="utf-8")
    for name in NAMES.values():
        default = f"{name.default} {name.unit}".strip()
        used = f"sets `{name.item}`" if name.item else "not used"
        why = f": {name.why}" if name.why else ""
        assert f"| `{name.name}` | {default} | {used}{why} |\n" in page


def test_a_file_with_all_names_is_read() -> None:
    given = parse(ALL, "all")
    assert len(given) == len(NAMES) == 137
    assert all(one.name.item or one.name.why for one in given.values())
    assert given["turn_rate"].value == pytest.approx(0.174533, abs=1e-6)
    found = settings_of(given, 10.0)
    assert found["daa.well_clear.dthr_m"].value == pytest.approx(9.144)
    assert found["vehicles[].max_climb_m_s"].value == pytest.approx(2.54)
    assert found["vehicles[].max_bank_deg"].value == pytest.approx(10.0915, abs=1e-3)
    assert "bridge.instances" not in found
    assert settings_of(parse("passive_mode = true", "p"), 10.0)["bridge.instances"].value == 0


def test_the_lower_of_climb_and_descent_counts() -> None:
    found = settings_of(parse("max_vs = 300 [fpm]\nmin_vs = -500 [fpm]", "p"), 10.0)
    assert found["vehicles[].max_climb_m_s"].name == "max_vs"
    assert found["vehicles[].max_climb_m_s"].value == pytest.approx(1.524)


def test_names_that_ship_misspelt_are_read() -> None:
    assert list(parse("pos_model_undertainty_xx = 10.0 [m^2]", "p")) == ["pos_model_uncertainty_xx"]


@pytest.mark.parametrize(
    ("line", "item", "expected"),
    [
        ("lokahead_time = 3 [s]", "lokahead_time", "lookahead_time"),
        ("zzz = 3", "zzz", "one of the names of `cratous params --names`"),
        ("lookahead_time = 3 [m]", "lookahead_time", "s or ms or min or h"),
        ("lookahead_time = soon", "lookahead_time", "a finite number, then its unit"),
        ("lookahead_time = -1 [s]", "lookahead_time", "at least"),
        ("obstacle_buffer = -1 [m]", "obstacle_buffer", "at least 0 m"),
        ("passive_mode = 2", "passive_mode", "true or false"),
        ("lookahead_time", "", "key = value [unit]"),
        ("min_hs = 9 [knot]\nmax_hs = 3 [knot]", "min_hs", "at most 3 [knot]"),
        ("min_vs = 3 [fpm]", "min_vs", "less than 0"),
        ("alerters =", "alerters", "a word such as default"),
        ("default_load_core_detection_det_1 = gov.nasa.larcfm.ACCoRD.CDCylinder",
         "default_load_core_detection_det_1", "WCV_TAUMOD (modified tau)"),
        ("turn_rate = 3 [deg/s]\nturn_rate = 4 [deg/s]", "turn_rate", "one line"),
    ],
)  # fmt: skip
def test_what_is_none_of_it_is_refused(line: str, item: str, expected: str) -> None:
    with pytest.raises(BadInput) as caught:
        parse(f"# a comment\n{line}\n", "p.txt")
    assert caught.value.item == item
    assert caught.value.where.startswith("p.txt:")
    assert expected in caught.value.expected


def test_a_file_alone_is_explained(run: Run, tmp_path: Path) -> None:
    (tmp_path / "p.txt").write_text("lookahead_time = 30 [s]\nfence_action = 1\n", encoding="utf-8")
    code, out, err = run("params", "--icarous", tmp_path / "p.txt")
    assert (code, err) == (0, "")
    assert "daa.lookahead_s" in out
    assert "zones are kept by the plan and by every manoeuvre" in out
    assert "1 of 2 lines set something here" in out
    assert run("params")[0] == 2
    assert len(json.loads(run("params", "--names", "--json")[1])["names"]) == 137
