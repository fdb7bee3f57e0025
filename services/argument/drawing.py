"""argument.svg: drawings of the argument, one of the top level and one of each guarantee, in one file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape

from cratous.services.argument.elements import Element, Kind, State
from cratous.services.argument.escaping import plain_text
from cratous.services.argument.figures import DIAMOND, SKEW, Figure, figure
from cratous.services.argument.layers import GUTTER, Layout, laid_out
from cratous.services.argument.wrapping import LINE, SIZE, Line, width

EDGE, HEAD = 24.0, 34.0
"""Margin around all drawings, and space above each."""
COLOURS = {
    State.SUPPORTED: ("#ffffff", "#1b1b1b"),
    State.NOTHING: ("#f0f0f0", "#6b6b6b"),
    State.NO_THEOREM: ("#f0f0f0", "#6b6b6b"),
    State.NO_GROUND: ("#fdeed2", "#a15c00"),
    State.NOT_PROVED: ("#fdeed2", "#a15c00"),
    State.EXCUSED: ("#fdeed2", "#a15c00"),
    State.UNKNOWN: ("#fdeed2", "#a15c00"),
    State.VIOLATED: ("#fbdcdc", "#b00020"),
}
"""Fill and outline; the text states the state as well."""
FONT = "'DejaVu Sans', Verdana, Arial, sans-serif"


class Panel:
    """One drawing: a goal and what supports it. cut: goals developed in drawings of their own."""

    def __init__(self, elements: dict[str, Element], root: str, cut: Iterable[str] = ()) -> None:
        self.root = root
        stops = frozenset(cut)
        lines: dict[str, list[str]] = {}
        todo = [root]
        while todo:
            name = todo.pop()
            if name in lines:
                continue
            one = elements[name]
            below = [] if name in stops else [*one.in_context_of, *one.supported_by]
            lines[name] = below
            todo += reversed(below)
        self.figures = {
            name: figure(
                elements[name], f"developed in the drawing {name}" if name in stops else ""
            )
            for name in lines
        }
        sizes = {name: (f.width, f.height + f.tail) for name, f in self.figures.items()}
        self.layout: Layout = laid_out(root, lines, sizes)

    def boxes(self) -> dict[str, tuple[float, float, float, float]]:
        """Left, upper, right and lower edge of each figure with its decoration below."""
        return {
            name: (
                x,
                y,
                x + self.figures[name].width,
                y + self.figures[name].height + self.figures[name].tail,
            )
            for name, (x, y) in self.layout.places.items()
        }


def panels(elements: dict[str, Element]) -> list[Panel]:
    """The drawing of the top level, and one for each goal below its strategies."""
    root = next(iter(elements))
    strategies = elements[root].supported_by
    goals = [goal for strategy in strategies for goal in elements[strategy].supported_by]
    return [Panel(elements, root, goals), *(Panel(elements, goal) for goal in goals)]


def svg(elements: dict[str, Element], title: str, remarks: Iterable[str]) -> str:
    """The SVG text. title: its subject; remarks: lines below the title."""
    drawn = panels(elements)
    said = [plain_text(line) for line in remarks]
    legend = Panel(_legend(), "G-legend")
    body: list[str] = []
    y = EDGE + HEAD + LINE * len(said)
    wide = max(width(line) for line in [title, *said]) * 2
    for panel, head in [
        (legend, "What the shapes say"),
        *((panel, _headline(elements[panel.root])) for panel in drawn),
    ]:
        body.append(_text(head, EDGE, y + 20, bold=True, size=14))
        body.append(f'<g transform="translate({_n(EDGE)},{_n(y + HEAD)})">')
        body += _panel(panel)
        body.append("</g>")
        y += HEAD + panel.layout.size[1] + 2 * EDGE
        wide = max(wide, panel.layout.size[0], width(head) * 1.7)
    wide += 2 * EDGE
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_n(wide)}" height="{_n(y)}" '
        f'viewBox="0 0 {_n(wide)} {_n(y)}" font-family="{FONT}" font-size="{_n(SIZE)}">',
        f"<title>{escape(plain_text(title))}</title>",
        f'<rect width="{_n(wide)}" height="{_n(y)}" fill="#ffffff"/>',
        _text(plain_text(title), EDGE, EDGE + 16, bold=True, size=18),
        *(_text(line, EDGE, EDGE + HEAD + LINE * number) for number, line in enumerate(said)),
        *body,
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _headline(goal: Element) -> str:
    return f"Drawing {goal.id}: {goal.state}"


def _legend() -> dict[str, Element]:
    """One figure of each kind, as a small argument."""
    one = [
        Element("G-legend", Kind.GOAL, "Goal: what is claimed", ("S-legend",), ("C-legend", "A-legend")),
        Element("C-legend", Kind.CONTEXT, "Context (line with an open head)"),
        Element("A-legend", Kind.ASSUMPTION, "Assumption"),
        Element("S-legend", Kind.STRATEGY, "Strategy: how it is argued", ("G-open", "G-bad", "G-violated", "Sn-legend")),
        Element("Sn-legend", Kind.SOLUTION, "Solution: evidence"),
        Element("G-open", Kind.GOAL, "a goal that nothing supports (diamond), and that takes nothing from the one above", state=State.NO_THEOREM),
        Element("G-bad", Kind.GOAL, "a goal that is not supported", state=State.UNKNOWN),
        Element("G-violated", Kind.GOAL, "a goal that is not supported, with what shows that it is not so", state=State.VIOLATED),
    ]  # fmt: skip
    return {element.id: element for element in one}


def _panel(panel: Panel) -> Iterator[str]:
    for (start, end), heights in panel.layout.routes.items():
        yield _line(panel, start, end, heights)
    for name, (x, y) in panel.layout.places.items():
        found = panel.figures[name]
        yield f'<g transform="translate({_n(x)},{_n(y)})"><title>{escape(name)}</title>'
        yield from _outline(found)
        centred = found.element.kind in (Kind.SOLUTION, Kind.ASSUMPTION)
        left = {Kind.STRATEGY: SKEW}.get(found.element.kind, 0.0) + 9
        for number, line in enumerate(found.lines):
            at = found.width / 2 if centred else left
            yield _text(line, at, found.top + number * LINE + SIZE, centred=centred)
        yield "</g>"


def _line(panel: Panel, start: str, end: str, heights: list[float]) -> str:
    """A line from the right edge of a figure to the left edge of another, bending only between columns."""
    places, figures = panel.layout.places, panel.figures
    x, y = places[start][0] + figures[start].width, places[start][1] + figures[start].height / 2
    path = [f"M{_n(x)} {_n(y)}"]
    column = panel.layout.column_of[start]
    last = places[end][1] + figures[end].height / 2
    for number, height in enumerate([*heights, last], column):
        right, left = panel.layout.columns[number][1], panel.layout.columns[number + 1][0]
        tip = left - 8 if number + 1 == panel.layout.column_of[end] else left
        bend = GUTTER / 2
        path.append(
            f"H{_n(right)}C{_n(right + bend)} {_n(y)} {_n(tip - bend)} {_n(height)} {_n(tip)} {_n(height)}"
        )
        y = height
    element = panel.figures[end].element
    context = element.kind in (Kind.CONTEXT, Kind.ASSUMPTION)
    _, colour = COLOURS[element.state]
    dash = ' stroke-dasharray="5 4"' if element.state is not State.SUPPORTED else ""
    tip = panel.layout.columns[panel.layout.column_of[end]][0]
    head = f"M{_n(tip - 9)} {_n(last - 4)}L{_n(tip)} {_n(last)}L{_n(tip - 9)} {_n(last + 4)}Z"
    fill = "#ffffff" if context else colour
    return (
        f'<path d="{"".join(path)}" fill="none" stroke="{colour}" stroke-opacity="0.65"{dash}/>'
        f'<path d="{head}" fill="{fill}" stroke="{colour}"/>'
    )


def _outline(found: Figure) -> Iterator[str]:
    w, h, kind = found.width, found.height, found.element.kind
    fill, colour = COLOURS[found.element.state]
    style = f'fill="{fill}" stroke="{colour}" stroke-width="1.4"'
    if kind is Kind.SOLUTION:
        yield f'<circle cx="{_n(w / 2)}" cy="{_n(h / 2)}" r="{_n(w / 2)}" {style}/>'
    elif kind is Kind.ASSUMPTION:
        yield f'<ellipse cx="{_n(w / 2)}" cy="{_n(h / 2)}" rx="{_n(w / 2)}" ry="{_n(h / 2)}" {style}/>'
        yield _text("A", w - 12, h - 1, bold=True, size=12)
    elif kind is Kind.STRATEGY:
        corners = f"{_n(SKEW)},0 {_n(w)},0 {_n(w - SKEW)},{_n(h)} 0,{_n(h)}"
        yield f'<polygon points="{corners}" {style}/>'
    else:
        round_ = f' rx="{_n(min(h / 2, 16))}"' if kind is Kind.CONTEXT else ""
        yield f'<rect width="{_n(w)}" height="{_n(h)}"{round_} {style}/>'
    if found.tail:
        x, half = w / 2, DIAMOND / 2
        points = f"{_n(x)},{_n(h)} {_n(x + half)},{_n(h + half)} {_n(x)},{_n(h + DIAMOND)} {_n(x - half)},{_n(h + half)}"
        yield f'<polygon points="{points}" {style}/>'


def _text(
    line: str | Line,
    x: float,
    y: float,
    *,
    bold: bool = False,
    size: float = SIZE,
    centred: bool = False,
) -> str:
    one = line if isinstance(line, Line) else Line(line, bold)
    weight = ' font-weight="bold"' if one.bold else ""
    height = f' font-size="{_n(size)}"' if size != SIZE else ""
    anchor = ' text-anchor="middle"' if centred else ""
    return f'<text x="{_n(x)}" y="{_n(y)}"{weight}{height}{anchor}>{escape(one.text)}</text>'


def _n(value: float) -> str:
    """A coordinate of the drawing, to a tenth."""
    return f"{value:.1f}".removesuffix(".0")
