"""The lint of decisions outside of kernels and drivers."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cratous.proofs.lint import decisions


def test_every_decision_outside_of_kernels_is_explained():
    assert decisions.unexplained() == []


def test_the_explanations_are_few_and_those_without_a_kernel_are_counted():
    counts = decisions.counted()
    assert sum(counts.values()) == len(decisions.places())
    assert len(decisions.explanations()) <= 50
    assert counts["open"] == 0, "every decision has a kernel"


SOURCE = """
from shapely import Point


class Watch:
    def late(self, now_ms, limit_ms):
        if now_ms > limit_ms:
            return True
        return self.at_ms is None


def inside(p, polygon, a, b):
    if polygon.contains(Point(p)):
        return True
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0


def own(gate, vehicle, UXAS, x, y, radius):
    return gate.owner == UXAS or math.hypot(x, y) < radius


def fine(count, names, wait_ms):
    return count > 3 and "a" in names and wait_ms == 0
"""


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    (tmp_path / "services").mkdir()
    (tmp_path / "services" / "some.py").write_text(SOURCE)
    return tmp_path


def test_what_looks_like_a_decision_is_found(tree: Path):
    found = decisions.places(tree, ("services",))
    assert [(p.function, p.subject) for p in found] == [
        ("Watch.late", "measure"),
        ("inside", "geometry"),
        ("inside", "geometry"),
        ("own", "authority"),
        ("own", "geometry"),
    ]
    assert "use a kernel or fold of core" in str(found[1])
    assert "services/some.py:7" in str(found[0])


def test_an_unexplained_place_and_an_idle_explanation_are_named(tree: Path):
    file = tree / "decisions.json"
    rows = [
        {"file": "services/some.py", "functions": ["inside", "own"], "kind": "open", "reason": "x"},
        {"file": "services/some.py", "functions": ["gone"], "kind": "input", "reason": "x"},
    ]
    file.write_text(json.dumps(rows))
    places, known = decisions.places(tree, ("services",)), decisions.explanations(file)
    left = [p for p in places if not any(e.covers(p) for e in known)]
    assert [p.function for p in left] == ["Watch.late"]
    wrong = decisions.unexplained(tree, file, ("services",))
    assert len(wrong) == 2
    assert "now_ms > limit_ms" in wrong[0]
    assert "services/some.py:gone decides nothing any more" in wrong[1]


def test_an_explanation_explains(tmp_path: Path):
    file = tmp_path / "decisions.json"
    row = {"file": "a.py", "functions": ["f"], "kind": "because", "reason": "x"}
    for bad in (row, {**row, "kind": "open", "reason": " "}, {**row, "functions": []}):
        file.write_text(json.dumps([bad]))
        with pytest.raises(ValueError, match="expected a kind of"):
            decisions.explanations(file)
