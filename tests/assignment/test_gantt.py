"""Pictures of assignments: what is drawn is what was planned."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from pathlib import Path

from cratous.services.certify.gantt import Bar, gantt, tree, windows_of
from cratous.services.cli import main
from cratous.spec.algebra import parse
from cratous.spec.constraint_rows import NOT_AFTER, NOT_BEFORE, Row

BARS = [Bar(4, 1, 0, 100, 100, 300), Bar(4, 2, 300, 400, 700, 1000), Bar(9, 3, 0, 50, 50, 90)]


def shapes(picture: str, name: str) -> list[ET.Element]:
    return [e for e in ET.fromstring(picture).iter() if e.tag.split("}")[-1] == name]


def test_lanes_bars_and_loiters_are_to_scale() -> None:
    picture = gantt(BARS, (4, 9))
    titled = {
        t.text or "": r for r in shapes(picture, "rect") for t in r if t.tag.endswith("title")
    }
    first, second = (
        next(r for t, r in titled.items() if t.startswith(f"task {k}")) for k in (1, 2)
    )
    assert float(second.get("width", 0)) == 1.5 * float(first.get("width", 0))
    loiter = titled["loiter 0.300 s"]
    assert float(loiter.get("width", 0)) == float(second.get("width", 0))
    words = [t.text for t in shapes(picture, "text")]
    assert {"vehicle 4", "vehicle 9", "p1", "p2", "p3"} <= set(words)


def test_a_window_is_drawn_with_its_task() -> None:
    rows = [Row(NOT_BEFORE, 2, (), 500, 0, ""), Row(NOT_AFTER, 2, (), 0, 1200, ""),
            Row(NOT_AFTER, 2, (), 0, 1100, "")]  # fmt: skip
    assert windows_of(rows) == {2: (500, 1100)}
    plain, windowed = (len(shapes(gantt(BARS, (4, 9), r), "path")) for r in ([], rows))
    assert windowed == plain + 1
    assert "window 0.500 to 1.100 s" in gantt(BARS, (4, 9), rows)


def test_the_tree_has_every_operator_task_and_timing() -> None:
    picture = tree(parse("|(.(p1 p2 p3)-[0-5000] +(p4 ~(p5 p6)) p7_[1000-2000])"))
    assert len(shapes(picture, "circle")) == 4
    assert len(shapes(picture, "line")) == 10
    words = "".join("".join(t.itertext()) for t in shapes(picture, "text"))
    assert all(f"p{k}" in words for k in range(1, 8))
    assert "-[0 s, 5 s]" in words
    assert "_[1 s, 2 s]" in words
    inside = float(ET.fromstring(picture).get("width", 0))
    assert all(
        float(r.get("x", 0)) + float(r.get("width", 0)) <= inside for r in shapes(picture, "rect")
    )


def test_assign_draws_a_file(tmp_path: Path) -> None:
    problem = {
        "vehicles": [{"id": 1}], "travel_ms": [[0, 5], [5, 0]], "start_cost_ms": [[3, 4]],
        "tasks": [{"id": k, "duration_ms": 7, "eligible": [1]} for k in (1, 2)],
        "process_algebra": ".(p2 p1)",
    }  # fmt: skip
    (tmp_path / "p.json").write_text(json.dumps(problem))
    assert main(["assign", str(tmp_path / "p.json"), "--svg", str(tmp_path / "p.svg")]) == 0
    picture = (tmp_path / "p.svg").read_text()
    assert ET.fromstring(picture).tag == "{http://www.w3.org/2000/svg}svg"
    assert "task 2: 0.004 to 0.011 s" in picture
    assert len(shapes(picture, "circle")) == 1
