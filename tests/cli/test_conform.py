"""`cratous conform`: vectors against kernels, and what is not covered is never passed."""

from __future__ import annotations

import gzip
import json
import re
from pathlib import Path

import pytest

from cratous.core import geofence
from cratous.services.cli import main
from cratous.services.conform import cases, polygon, run, suite, well_clear
from cratous.spec.errors import BadInput

CLEAR = {
    "id": "edge", "s": [1250, 0, 0], "v": [10, 0, 0], "D": 1250, "Z": 100, "TTHR": 30, "TCOA": 20,
    "x_exact_h": True, "x_exact_v": True,
}  # fmt: skip
CORNER = {
    "id": "corner", "kind": "contain2d", "polygon": [[0, 0], [4, 0], [4, 3]], "point": [2, 0],
    "exact": {"location": "boundary"},
}  # fmt: skip


def _file(folder: Path, *cases: dict, name: str = "cases.jsonl") -> Path:
    file = folder / name
    file.write_text("".join(json.dumps(case) + "\n" for case in cases), encoding="utf-8")
    return file


def test_verdicts_on_the_edge_are_exact():
    assert well_clear.judge(CLEAR).status == "passed"
    off = {**CLEAR, "s": [1250.0000000000002, 0, 0], "x_exact_h": False}
    assert well_clear.judge(off).status == "passed"
    assert well_clear.judge({**off, "x_exact_h": True}).status == "failed"
    assert polygon.judge(CORNER).status == "passed"
    above = {**CORNER, "point": [2, 5e-324], "exact": {"location": "inside"}}
    assert polygon.judge(above).status == "passed"


NEAR = {
    "id": "near", "polygon": [[0, 0], [10, 0], [10, 10], [0, 10]], "point": [13, 14], "buffer": 5,
    "exact": {"location": "outside", "near": False, "dist2": "25"},
}  # fmt: skip
LAYER = {
    "id": "ceiling", "polygon": [[0, 0], [10, 0], [10, 10], [0, 10]], "point": [5, 5, 120],
    "floor": 0, "ceiling": 120, "buffer": 5, "exact": {"location": "boundary", "location2d": 1},
}  # fmt: skip


def test_nearness_distances_and_layers_are_judged():
    assert (polygon.judge(NEAR).status, polygon.judge(NEAR).checks) == ("passed", 6)
    wider = {**NEAR, "buffer": 5.000000000000001}
    assert polygon.judge(wider).label == "near the boundary: no taken for yes"
    for change, label in (
        ({"near": True}, "near the boundary: yes taken for no"),
        ({"dist2": ["25", "2"]}, "squared distance: 25/2 taken for 25"),
    ):
        result = polygon.judge({**NEAR, "exact": {**NEAR["exact"], **change}})
        assert (result.status, result.label) == ("failed", label)
    assert polygon.judge(LAYER).status == "passed"
    assert polygon.judge({**LAYER, "point": [5, 5, 121]}).label == "boundary taken for outside"
    in_plane = {**LAYER, "exact": {"location": "boundary", "location2d": 0}}
    assert polygon.judge(in_plane).label.startswith("location in the plane")
    far = {k: v for k, v in NEAR.items() if k != "exact"}
    assert polygon.judge({**far, "dist_to_boundary": 5.0}).status == "passed"
    assert polygon.judge({**far, "dist_to_boundary": 5.1}).status == "failed"
    for bad in ("5/0", "five", ["1"]):
        with pytest.raises(BadInput, match="no fraction"):
            polygon.judge({**NEAR, "exact": {**NEAR["exact"], "dist2": bad}})


def test_a_list_of_cases_is_read_too(tmp_path: Path):
    file = tmp_path / "cases.json"
    file.write_text(json.dumps([NEAR, LAYER], indent=1), encoding="utf-8")
    assert run(suite("polygon"), file, 3).passed == 2
    file.write_text("[1]", encoding="utf-8")
    with pytest.raises(BadInput, match="case 1"):
        run(suite("polygon"), file, 3)


@pytest.mark.parametrize("wrong", ["x_exact_h", "x_exact_v"])
def test_a_wrong_vector_fails_and_says_how(wrong: str):
    result = well_clear.judge({**CLEAR, wrong: False, "kind": "thr_dist"})
    assert result.status == "failed"
    assert "missed (thr_dist)" in result.label
    assert "expected clear, got violated" in result.text
    result = polygon.judge({**CORNER, "exact": {"location": "inside"}})
    assert (result.status, result.label) == ("failed", "inside taken for boundary")


def test_what_is_not_covered_is_not_passed(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    file = _file(tmp_path, {**CLEAR, "det": "WCV_TAU"}, {**CLEAR, "det": "TCAS3D"})
    assert main(["conform", "well-clear", str(file)]) == 3
    out = capsys.readouterr().out.splitlines()
    assert "not covered: 1 detector TCAS3D, 1 detector WCV_TAU" in out[0]
    assert out[-1] == "0 passed, 0 failed"
    for kind in ("moving2d", "moving3d", "recovery2d"):
        assert polygon.judge({**CORNER, "kind": kind}).status == "not covered"
    assert polygon.judge({**CORNER, "exact": {}}).status == "not covered"
    bare = {k: v for k, v in CLEAR.items() if not k.startswith("x_")}
    assert well_clear.judge(bare).status == "not covered"


def test_the_command_counts_shows_and_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    bad = {**CLEAR, "x_exact_h": False}
    file = _file(tmp_path, CLEAR, bad, bad, bad)
    assert main(["conform", "well-clear", str(file), "--show", "2"]) == 1
    out = capsys.readouterr().out.splitlines()
    assert out[0] == f"{file}: 1 passed, 3 failed"
    assert "3 x horizontal clear missed" in out[1]
    assert sum("    edge: " in line for line in out) == 2
    assert out[-1] == "1 passed, 3 failed"
    assert main(["conform", "well-clear", str(file), "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert (data["passed"], data["failed"], data["checks"], data["exit_code"]) == (1, 3, 16, 1)


def test_gzip_and_several_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    packed = tmp_path / "cases.jsonl.gz"
    packed.write_bytes(gzip.compress(json.dumps(CORNER).encode() + b"\n\n"))
    plain = _file(tmp_path, CORNER, CORNER)
    assert main(["conform", "polygon", str(packed), str(plain)]) == 0
    out = capsys.readouterr().out.splitlines()
    assert len(out) == 3
    assert out[-1] == "3 passed, 0 failed"


@pytest.mark.parametrize(
    ("change", "item"),
    [
        ({"s": [1, 2]}, "s"),
        ({"s": [1, 2, "x"]}, "s"),
        ({"s": [1, 2, float("nan")]}, "s"),
        ({"v": [1, 2, float("inf")]}, "v"),
        ({"D": -1}, "D"),
        ({"TCOA": -0.5}, "TCOA"),
        ({"TTHR": True}, "TTHR"),
        ({"Z": 2**53 + 1}, "Z"),
        ({"x_exact_v": 1}, "x_exact_v"),
        ({"x_exact_h": None}, "x_exact_h"),
    ],
)
def test_bad_values_are_refused_with_the_line(
    change: dict, item: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    file = _file(tmp_path, CLEAR, {**CLEAR, **change})
    assert main(["conform", "well-clear", str(file)]) == 2
    error = capsys.readouterr().err
    assert f"{file}:2" in error
    assert item in error


@pytest.mark.parametrize(
    "change",
    [
        {"polygon": [[0, 0], [1, 0]]},
        {"polygon": [[0, 0], [1, 0], [1]]},
        {"polygon": "square"},
        {"point": None},
        {"exact": {"location": "somewhere"}},
    ],
)
def test_bad_polygons_are_refused(change: dict):
    with pytest.raises(BadInput):
        polygon.judge({**CORNER, **change})


@pytest.mark.parametrize(
    ("text", "wanted"),
    [("", "no cases"), ("{", "not JSON"), ("[1]", "JSON object"), ("\xff", "not a text file")],
)
def test_files_that_are_none(
    text: str, wanted: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    file = tmp_path / "bad.jsonl"
    file.write_bytes(text.encode("latin-1"))
    assert main(["conform", "polygon", str(file)]) == 2
    assert wanted in capsys.readouterr().err
    assert main(["conform", "polygon", str(tmp_path / "none.jsonl")]) == 2
    assert "no such file" in capsys.readouterr().err


def test_unknown_suite_and_no_file(capsys: pytest.CaptureFixture[str]):
    assert main(["conform", "weather", "x"]) == 2
    assert "expected well-clear or polygon or lmcp" in capsys.readouterr().err
    assert main(["conform", "polygon"]) == 2
    with pytest.raises(BadInput):
        suite("weather")


def test_the_examples_of_the_page_hold(root: Path, tmp_path: Path):
    text = (root / "docs" / "reference" / "conformance.md").read_text(encoding="utf-8")
    examples = re.findall(r"^```json\n(.*?)\n```", text, re.M | re.S)
    assert len(examples) == 2
    for judge, example in zip((well_clear.judge, polygon.judge), examples, strict=True):
        assert judge(json.loads(example)).status == "passed"


SPAN = {
    **CLEAR, "s": [3000, 0, 0], "v": [-60, 0, 0], "D": 1250, "TTHR": 0, "TCOA": 0, "B": 0, "T": 60,
    "x_exact_h": False, "conflict": True, "tin": 29.166666666666668, "tout": 60,
}  # fmt: skip


@pytest.mark.parametrize("detector", ["WCV_TAUMOD", "WCV_TCPA", "WCV_TEP", "CDCylinder"])
def test_instants_over_a_span_are_compared(detector: str):
    case = {**SPAN, "det": detector}
    assert well_clear.judge(case).status == "passed"
    edge = well_clear.judge({**case, "tin": 29.16666666667})
    assert (edge.status, edge.label[:6]) == ("knife edge", "entry:")
    for wrong in ({"tin": 29.1667}, {"tout": 59.9}, {"conflict": False}, {"tin": 0}):
        result = well_clear.judge({**case, **wrong})
        assert result.status == "failed", wrong
        assert "over [B, T]" in result.label


def test_a_knife_edge_is_said_and_not_passed(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    touching = {**CLEAR, "B": 0, "T": 60, "conflict": False, "tin": "inf", "tout": "-inf"}
    file = _file(tmp_path, touching, SPAN)
    assert main(["conform", "well-clear", str(file)]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[0].endswith("1 passed, 0 failed, 1 on a knife edge")
    assert "1 x knife edge: detection: within 16348 units in the last place" in out[1]
    assert out[2].startswith("    edge: over [0, 60] s ours is")
    assert out[-1] == "1 passed, 0 failed, 1 on a knife edge"
    assert main(["conform", "well-clear", str(file), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["knife_edges"] == 1
    assert [case["id"] for case in data["files"][0]["knife_edge_cases"]] == ["edge"]
    inside = {**touching, "s": [1249.9, 0, 0]}
    assert well_clear.judge(inside).status == "failed"


# -- published vectors ------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("detector", "edges"),
    [("WCV_TAUMOD", 36), ("WCV_TCPA", 37), ("WCV_TEP", 39), ("CDCylinder", 43)],
)
def test_published_well_clear_vectors(shared: Path, detector: str, edges: int):
    file = shared / "vectors" / "daidalus" / f"open-wcv-{detector}.jsonl.gz"
    report = run(suite("well-clear"), file, 3)
    assert [r.text for r in report.shown] == []
    assert (report.passed, report.failed) == (2000 - edges, 0)
    assert report.edges.total() == len(report.edge_cases) == edges
    assert report.checks >= 9000
    assert sum(n for label, n in report.edges.items() if "detection" in label) <= 31


@pytest.mark.parametrize("number", range(1, 7))
def test_published_polygon_vectors(shared: Path, number: int):
    file = shared / "vectors" / "polycarp" / f"open-polycarp-{number}.jsonl.gz"
    report = run(suite("polygon"), file, 3)
    assert [r.text for r in report.shown] == []
    assert (report.passed, report.failed) == (330, 0)
    assert report.skipped == {"moving2d": 100, "moving3d": 50, "recovery2d": 20}


@pytest.mark.long
@pytest.mark.parametrize("name", ["adversarial-202", "random-101"])
def test_polygons_that_others_get_wrong(shared: Path, name: str):
    file = shared / "vectors" / "polycarp" / f"open-wrong-{name}.jsonl.gz"
    report = run(suite("polygon"), file, 3)
    assert [r.text for r in report.shown] == []
    assert report.failed == 0
    assert report.passed == {"adversarial-202": 9578, "random-101": 5703}[name]


def test_points_that_a_gate_for_nice_polygons_misses(shared: Path):
    file = shared / "vectors" / "polycarp" / "polycarp-3d-violation-missed-by-niceness.json"
    report = run(suite("polygon"), file, 3)
    assert (report.passed, report.failed) == (200, 0)
    for _, case in cases(file):
        shape = geofence.region(
            case["polygon"], floor_m=case["floor"], ceiling_m=case["ceiling"], metres=False
        )
        assert geofence.place(case["point"], shape) is geofence.Place.INSIDE
