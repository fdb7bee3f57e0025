"""`cratous import`: from files of ICAROUS to a mission that is flown."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from cratous.services.exporting.exported import GEOJSON, KML, exported
from cratous.services.importing.composing import Asked, composed
from cratous.services.importing.gathering import gathered
from cratous.services.importing.imported_content import Intruder, Parts, Place, Reading, Way
from cratous.services.loading import load
from cratous.services.parameters.parameter_file import parse
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, ZoneKind

Run = Callable[..., tuple[int, str, str]]
FILES = "examples/icarous-files"


@pytest.fixture
def taken(run: Run, root: Path, tmp_path: Path) -> Path:
    """The mission made of the example's files."""
    code, out, err = run("import", root / FILES, "-o", tmp_path / "mission.yaml")
    assert (code, out) == (0, "")
    assert "not used here: daa_resolution_type, fence_action (" in err
    assert "from the ground at 0 m (--terrain), and it starts at 40 m above sea level" in err
    return tmp_path / "mission.yaml"


def test_the_files_say_what_the_mission_says(taken: Path) -> None:
    mission = load(taken)
    (vehicle,) = mission.vehicles
    assert (vehicle.speed_m_s, vehicle.position.alt_m) == (8.0, 40.0)
    assert vehicle.min_speed_m_s == pytest.approx(10 * 1852 / 3600)
    assert vehicle.max_climb_m_s == pytest.approx(2.54)
    assert [task.id for task in mission.tasks] == [101, 102, 103, 104]
    assert mission.relations == ".(p101 p102 p103 p104)"
    assert mission.tasks[1].points[0].east_m == pytest.approx(300, abs=1)
    assert [zone.kind for zone in mission.zones] == [ZoneKind.KEEP_IN, ZoneKind.KEEP_OUT]
    assert mission.daa.well_clear.dthr_m == pytest.approx(30.48)
    assert mission.daa.lookahead_s == 40.0
    assert [one.id for one in mission.traffic] == [7, 8]
    assert mission.traffic[1].appears_ms == 20_000
    assert "not used here: daa_resolution_type" in taken.read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_mission_is_flown(run: Run, taken: Path, tmp_path: Path) -> None:
    """ICAROUS avoids the aircraft that comes along the second leg, keeps the fences, and flies all waypoints."""
    run("run", taken, "--out", tmp_path / "out", "--quiet", "--allow-unproved")
    report = json.loads((tmp_path / "out/icarous-files/report.json").read_text(encoding="utf-8"))
    assert {r["requirement"]: r["verdict"] for r in report["requirements"]} == dict.fromkeys(
        ["G1", "G2", "G3", "G4", "G5"], "holds"
    )
    assert [one["task"] for one in report["flight"]["served"]] == [101, 102, 103, 104]
    assert {one["intruder"] for one in report["flight"]["takeovers"]} == {7}


@pytest.mark.parametrize("form", [GEOJSON, KML])
def test_what_is_exported_for_maps_comes_back(
    root: Path, tmp_path: Path, form: str, popup: Mission
) -> None:
    (text,) = exported(popup, form).files.values()
    (tmp_path / f"m.{form}").write_text(text, encoding="utf-8")
    (tmp_path / "p.txt").write_text(
        "QGC WPL 110\n0 1 0 16 0 0 0 0 37.1 -76.4 300 1\n1 0 0 16 0 0 0 0 37.11 -76.4 300 1\n"
    )
    parts = gathered([tmp_path], Reading())
    assert any("not taken over" in note for note in parts.notes)
    assert len(parts.fences) == len(popup.zones) > 0
    for fence, zone in zip(parts.fences, popup.zones, strict=True):
        assert fence.keep_out == (zone.kind is ZoneKind.KEEP_OUT)
        assert (fence.floor_m, fence.ceiling_m) == (zone.floor_m, zone.ceiling_m)
        assert len(fence.corners) == len(zone.vertices)


@pytest.fixture
def popup(root: Path) -> Mission:
    return load(root / "examples/popup/mission.yaml")


def way(label: str, count: int, alt_m: Callable[[int], float] = lambda _: 50.0) -> Way:
    places = tuple(Place(50 + k / 1000, 8.0, alt_m(k), True) for k in range(count))
    return Way(label, places, 10.0, f"{label}.txt")


def test_a_long_plan_is_a_line_and_many_plans_are_many_vehicles() -> None:
    made = composed(Parts(ways=(way("a", 3), way("b", 2))), Asked("two", terrain_m=20.0)).data
    assert made["relations"] == "|(.(p101 p102) p201)"
    assert [v["position"]["alt_m"] for v in made["vehicles"]] == [70.0, 70.0]
    long = composed(Parts(ways=(way("a", 66),)), Asked("long"))
    (task,) = long.data["tasks"]
    assert (task["kind"], len(task["points"])) == ("line_search", 66)
    assert any("one task: a line" in note for note in long.notes)
    with pytest.raises(BadInput, match="changes its altitude"):
        composed(Parts(ways=(way("a", 66, float),)), Asked("long"))


def test_traffic_keeps_its_ids_and_defaults_are_not_noted() -> None:
    """ICAROUS counts traffic from 1, so the vehicle takes the next number that is free."""
    spots = [Intruder(k, None, 900.0, 0.0, 9.0, (0.0, 0.0, 0.0), 0.0, "") for k in (1, 2, 2)]
    lines = ["fence_action = 0", "alt_bins = 2", "stale_threshold = 10 [s]", "passive_mode = true",
             "default_det_1_WCV_TTHR = 5 [s]"]  # fmt: skip
    plain = parse("\n".join(lines), "p")
    made = composed(Parts((way("a", 3),), (), tuple(spots), plain), Asked("ids"))
    assert [v["id"] for v in made.data["vehicles"]] == [3]
    assert [t["id"] for t in made.data["traffic"]] == [1, 2, 1002]
    assert made.data["relations"] == ".(p301 p302)"
    assert any("not used here: alt_bins (" in note for note in made.notes)
    left = (
        "not in the parameter file: DTHR 150 m, ZTHR 30 m, TCOA 0 s, look-ahead 60 s (our default)"
    )
    assert left in made.notes
    assert any("passive_mode: no vehicle has an ICAROUS" in note for note in made.notes)


def test_what_a_mission_lacks_is_asked_for(run: Run, tmp_path: Path) -> None:
    plan = tmp_path / "p.txt"
    plan.write_text("QGC WPL 110\n0 1 0 16 0 0 0 0 52 8 40 1\n1 0 0 16 0 0 0 0 52.01 8 40 1\n")
    code, _, err = run("import", plan)
    assert (code, "--speed M_S" in err) == (2, True)
    code, out, err = run("import", plan, "--speed", "9", "--name", "mine")
    assert (code, yaml.safe_load(out)["name"]) == (0, "mine")
    assert "no parameter file: DTHR 150 m" in err
    (tmp_path / "readme.md").write_text("words\n")
    code, _, err = run("import", tmp_path, "--speed", "9")
    assert (code, "readme.md: not read" in err) == (0, True)
    assert run("import", tmp_path / "readme.md", "--speed", "9")[0] == 2
    assert run("import", tmp_path / "nothing")[0] == 2
    code, _, err = run("import", "n" * 300)
    assert (code, "cannot be read" in err) == (2, True)
    plan.rename(tmp_path / "plan.md")
    assert run("import", plan.with_suffix(".md"), "--origin", "1", "--speed", "9")[0] == 2


def test_what_cannot_be_flown_is_not_written(run: Run, root: Path, tmp_path: Path) -> None:
    """A keep-in that the start is outside of."""
    for file in (root / FILES).iterdir():
        text = file.read_text(encoding="utf-8")
        (tmp_path / file.name).write_text(text.replace("52.0477532", "52.0504"), encoding="utf-8")
    code, _, err = run("import", tmp_path, "-o", tmp_path / "out.yaml")
    assert (code, "starts outside keep-in zone 1" in err) == (2, True)
    assert not (tmp_path / "out.yaml").exists()
