"""The argument as it is drawn: nothing on anything else, each text in its outline, the same bytes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from itertools import combinations, pairwise
from math import hypot
from pathlib import Path
from typing import Any

import pytest
import yaml
from certify_tools import ROOT, Run, read
from hypothesis import given, settings
from hypothesis import strategies as st
from lxml import etree

from cratous.services.argument import drawing
from cratous.services.argument.build import argument
from cratous.services.argument.drawing import Panel, panels, svg
from cratous.services.argument.elements import Element, Kind, State
from cratous.services.argument.figures import DIAMOND, SKEW, Figure, figure
from cratous.services.argument.form import faults
from cratous.services.argument.layers import GAP, GUTTER, laid_out
from cratous.services.argument.wrapping import LINE, Line, width, wrapped

SVG = "{http://www.w3.org/2000/svg}"
SILENCE = "system_silence_is_noticed_within_one_heartbeat"


@pytest.fixture(scope="module")
def elements(flown: Path) -> dict[str, Element]:
    return argument(read(flown), [("vehicle 7", "not covered")])


def apart(panel: Panel) -> None:
    """No figure touches another, and each is inside the drawing."""
    boxes = panel.boxes()
    wide, high = panel.layout.size
    for (one, a), (other, b) in combinations(boxes.items(), 2):
        beside = a[2] < b[0] or b[2] < a[0]
        over = a[3] < b[1] or b[3] < a[1]
        assert beside or over, (one, other)
    for name, (left, upper, right, lower) in boxes.items():
        assert left >= 0, name
        assert upper > -1e-6, name
        assert right <= wide + 1e-6, name
        assert lower <= high + 1e-6, name


def test_no_figure_lies_on_another(elements: dict[str, Element]) -> None:
    drawn = panels(elements)
    assert [panel.root for panel in drawn] == ["G-run", "G1", "G2", "G3", "G4", "G5"]
    for panel in drawn:
        apart(panel)
    # all elements are drawn, and where a goal stands twice its second drawing has what is below it
    assert {name for panel in drawn for name in panel.figures} == set(elements)
    for panel in drawn[1:]:
        for name in panel.figures:
            one = elements[name]
            for other in (*one.supported_by, *one.in_context_of):
                assert (name, other) in panel.layout.routes


def inside(found: Figure) -> None:
    """Each line of a figure lies within its outline."""
    kind, half, tall = found.element.kind, found.width / 2, found.height / 2
    assert found.lines
    for number, line in enumerate(found.lines):
        wide = width(line.text, bold=line.bold)
        upper = found.top + number * LINE
        assert upper >= 0
        assert upper + LINE <= found.height + 1e-6
        far = max(abs(upper - tall), abs(upper + LINE - tall))
        if kind is Kind.SOLUTION:
            assert hypot(wide / 2, far) <= half + 1e-6
        elif kind is Kind.ASSUMPTION:
            assert (wide / 2 / half) ** 2 + (far / tall) ** 2 <= 1 + 1e-6
        else:
            assert wide <= found.width - 2 * (SKEW if kind is Kind.STRATEGY else 0)


def test_every_text_lies_in_its_outline(elements: dict[str, Element]) -> None:
    for panel in panels(elements):
        for name, found in panel.figures.items():
            inside(found)
            said = "".join("".join(line.text.split()) for line in found.lines)
            assert said.startswith("".join((name + elements[name].shown).split()))
            assert found.tail == (DIAMOND if elements[name].undeveloped else 0)


@pytest.mark.parametrize("kind", list(Kind))
@given(text=st.text(min_size=1, max_size=300).filter(lambda text: bool(text.split())))
@settings(max_examples=40, deadline=None)
def test_any_text_lies_in_its_outline(kind: Kind, text: str) -> None:
    found = figure(Element(f"{kind}-x", kind, text))
    inside(found)
    etree.fromstring(f"<x>{drawing.escape(''.join(line.text for line in found.lines))}</x>")


@given(
    words=st.lists(st.text("abcW-_.", min_size=1, max_size=40), max_size=30),
    room=st.integers(180, 400),
)
@settings(deadline=None)
def test_wrapping_loses_nothing(words: list[str], room: int) -> None:
    lines = wrapped([Line(" ".join(words))], lambda _: room)
    assert lines is not None
    assert "".join("".join(line.text.split()) for line in lines) == "".join(words)
    assert all(width(line.text) <= room for line in lines)


@st.composite
def graphs(draw: Any) -> tuple[dict[str, list[str]], dict[str, tuple[float, float]]]:
    count = draw(st.integers(1, 25))
    lines: dict[str, list[str]] = {str(number): [] for number in range(count)}
    for number in range(1, count):
        above = draw(st.sets(st.integers(0, number - 1), min_size=1, max_size=4))
        for one in sorted(above):
            lines[str(one)].append(str(number))
    sizes = {name: (draw(st.floats(20, 300)), draw(st.floats(20, 300))) for name in lines}
    return lines, sizes


@given(graphs())
@settings(max_examples=80, deadline=None)
def test_any_argument_is_laid_out_apart(found: Any) -> None:
    lines, sizes = found
    laid = laid_out("0", lines, sizes)
    assert set(laid.places) == set(lines)
    boxes = {n: (x, y, x + sizes[n][0], y + sizes[n][1]) for n, (x, y) in laid.places.items()}
    for a, b in combinations(boxes.values(), 2):
        assert a[2] < b[0] or b[2] < a[0] or a[3] + GAP / 2 < b[1] or b[3] + GAP / 2 < a[1]
    for (_, right), (left, _) in pairwise(laid.columns):
        assert left - right == pytest.approx(GUTTER)
    for start, below in lines.items():
        for end in below:
            first, last = laid.column_of[start], laid.column_of[end]
            assert first < last
            passed = laid.routes[start, end]
            assert len(passed) == last - first - 1
            # where a line passes a column it meets no figure of it
            for height, column in zip(passed, range(first + 1, last), strict=True):
                for name, (_, upper, _, lower) in boxes.items():
                    if laid.column_of[name] == column:
                        assert not upper <= height <= lower, (start, end, name)


def test_lines_bend_between_columns_alone(elements: dict[str, Element]) -> None:
    """A line runs level beside its own figure, or where it passes; it rises and falls in the gutters."""
    for panel in panels(elements):
        boxes = panel.boxes()
        for start, end in panel.layout.routes:
            path = drawing._line(panel, start, end, panel.layout.routes[start, end])
            d = etree.fromstring(f"<g>{path}</g>")[0].get("d")
            points = _points(d)
            for one in points:
                for name, (left, upper, right, lower) in boxes.items():
                    if name not in (start, end):
                        assert not (left < one[0] < right and upper < one[1] < lower), (start, end)


def _points(d: str) -> list[tuple[float, float]]:
    """Points along a path of M, H and C with absolute coordinates."""
    import re

    found: list[tuple[float, float]] = []
    for letter, rest in re.findall("([MHC])([^MHC]*)", d):
        n = [float(number) for number in rest.split()]
        if letter == "M":
            found.append((n[0], n[1]))
        elif letter == "H":
            x, y = found[-1]
            found += [(x + (n[0] - x) * k / 10, y) for k in range(11)]
        else:
            a, b, c, e = found[-1], (n[0], n[1]), (n[2], n[3]), (n[4], n[5])
            for k in range(21):
                t, u = k / 20, 1 - k / 20
                weights = (u**3, 3 * u * u * t, 3 * u * t * t, t**3)
                found.append(
                    (
                        sum(w * p[0] for w, p in zip(weights, (a, b, c, e), strict=True)),
                        sum(w * p[1] for w, p in zip(weights, (a, b, c, e), strict=True)),
                    )
                )
    return found


def test_shapes_say_the_kind(elements: dict[str, Element]) -> None:
    whole = etree.fromstring(svg(elements, "title <&>", ["remark"]).encode())
    assert whole.find(f"{SVG}title").text == "title <&>"
    shapes = {Kind.SOLUTION: "circle", Kind.ASSUMPTION: "ellipse", Kind.STRATEGY: "polygon"}
    seen = set()
    for group in whole.iter(f"{SVG}g"):
        title = group.find(f"{SVG}title")
        if title is None or title.text not in elements:
            continue
        one = elements[title.text]
        tags = [etree.QName(part).localname for part in group]
        assert tags[1] == shapes.get(one.kind, "rect")
        rounded = group[1].get("rx") is not None
        assert rounded == (one.kind in (Kind.CONTEXT, Kind.ASSUMPTION))
        marks = [part for part in group.iter(f"{SVG}text") if part.text == "A"]
        assert len(marks) == (one.kind is Kind.ASSUMPTION)
        # an open goal has a diamond below it
        assert tags.count("polygon") == (one.kind is Kind.STRATEGY) + one.undeveloped
        fill = drawing.COLOURS[one.state]
        assert (group[1].get("fill"), group[1].get("stroke")) == fill
        seen.add(one.id)
    assert seen == set(elements)
    assert len({fill for fill, _ in drawing.COLOURS.values()}) == 4
    assert drawing.COLOURS[State.SUPPORTED] not in [
        colour for state, colour in drawing.COLOURS.items() if state is not State.SUPPORTED
    ]


def test_other_processes_give_the_same_bytes(flown: Path, tmp_path: Path) -> None:
    code = (
        "import json, sys\n"
        "from cratous.services.argument.views import views\n"
        "print(*views(json.load(open(sys.argv[1])), []), sep='\\n', end='')\n"
    )
    said = []
    for seed in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", code, str(flown / "report.json")],
            check=True, capture_output=True, timeout=300, env={**os.environ, "PYTHONHASHSEED": seed},
        )  # fmt: skip
        said.append(done.stdout)
    assert said[0] == said[1]
    assert len(said[0]) > 50_000


def test_a_flight_without_avoidance(
    run: Run, tmp_path: Path, fly_once: Callable[..., Path]
) -> None:
    """It loses well clear, and nothing is known of the bridge: both are in one true run."""
    flown = fly_once(ROOT / "examples" / "crossing" / "mission.yaml", "--no-daa")
    assert run("certify", flown, "--argument", "-o", tmp_path / "v")[0] == 1
    data = yaml.safe_load((tmp_path / "v" / "argument.yaml").read_text("utf-8"))
    assert faults(data) == []
    for name, state in (("G-run", "violated"), ("G2", "violated"), ("G5", "unknown")):
        assert data[name]["classes"] == [state]
        assert data[name]["text"].startswith(f"{state.upper()}: {name if name != 'G-run' else ''}")
    lost = [n for n, one in data.items() if "lost at" in one["text"]]
    assert len(lost) == 1
    assert data[lost[0]]["undeveloped"]
    theorem = data[f"G-theorem-{SILENCE}"]
    assert (theorem["classes"], theorem["undeveloped"]) == (["no-theorem"], True)
    drawn = (tmp_path / "v" / "argument.svg").read_text("utf-8")
    assert "VIOLATED: G2" in drawn
    assert "UNKNOWN: G5" in drawn
