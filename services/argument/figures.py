"""Geometry of each element: its outline, its size, and its text in lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, sqrt

from cratous.services.argument.elements import Element, Kind
from cratous.services.argument.escaping import plain_text
from cratous.services.argument.wrapping import LINE, Line, least_width, wrapped

PAD, SKEW = 9.0, 16.0
"""Padding around the text, and horizontal skew of a parallelogram."""
DIAMOND = 16.0
"""Height of the diamond below an undeveloped goal."""
WIDTHS = ((0, 190.0), (110, 230.0), (220, 290.0), (400, 380.0))
"""Width of an element's text, by its number of letters."""


@dataclass(frozen=True)
class Figure:
    """A drawn element. width, height: of the outline; tail: height of the decoration below it;
    lines: of text, the first `top` below the upper edge.
    """

    element: Element
    width: float
    height: float
    tail: float
    top: float
    lines: tuple[Line, ...]


def figure(element: Element, note: str = "") -> Figure:
    """The figure of an element; note: an additional last line, for example where it continues."""
    text = plain_text(element.shown)
    paragraphs = [
        Line(element.id, bold=True),
        Line(text),
        *([Line(note, bold=True)] if note else []),
    ]
    if element.kind is Kind.SOLUTION:
        return _circle(element, paragraphs)
    inner = next(wide for letters, wide in reversed(WIDTHS) if len(text) >= letters)
    lines = wrapped(paragraphs, lambda _: inner)
    if lines is None:  # a word is narrower than the narrowest box
        raise RuntimeError(f"the text of {element.id} cannot be broken into lines")
    high = len(lines) * LINE
    if element.kind is Kind.ASSUMPTION:
        # the text block lies within the ellipse through its corners
        wide, tall = (inner + PAD) * sqrt(2), (high + PAD) * sqrt(2)
        return Figure(element, ceil(wide), ceil(tall), 0.0, (ceil(tall) - high) / 2, tuple(lines))
    beside = PAD + (SKEW if element.kind is Kind.STRATEGY else 0.0)
    tail = DIAMOND if element.undeveloped else 0.0
    return Figure(element, inner + 2 * beside, high + 2 * PAD, tail, PAD, tuple(lines))


def _circle(element: Element, paragraphs: list[Line]) -> Figure:
    """The smallest circle, from a series of sizes, that contains the text."""
    across = 80.0
    while (found := _in_circle(element, paragraphs, across)) is None:
        across += 8.0
    return found


def _in_circle(element: Element, paragraphs: list[Line], across: float) -> Figure | None:
    """The text in a circle, in the fewest possible lines; None if it does not fit."""
    least = sum(least_width(one) for one in paragraphs)
    for count in range(1, int(across / LINE)):
        chords = _chords(across, count)
        if least > sum(chords) + 1e-6:  # wider than all lines, beyond rounding
            continue
        lines = wrapped(paragraphs, chords.__getitem__, count)
        if lines is not None:
            top = (across - count * LINE) / 2
            return Figure(element, across, across, 0.0, top, tuple(lines))
    return None


@lru_cache(maxsize=2048)  # each text is tried in circles of the same sizes
def _chords(across: float, count: int) -> tuple[float, ...]:
    """The maximum widths of `count` lines in a circle, followed by 0 for any further line."""
    return (*(_chord(across, count, line) for line in range(count)), 0.0)


def _chord(across: float, count: int, line: int) -> float:
    """Maximum width of a line in the circle: limited by the edge of the line farther from the centre."""
    edge = abs(line - (count - 1) / 2) * LINE + LINE / 2
    left = (across / 2 - PAD / 2) ** 2 - edge**2
    return 2 * sqrt(left) if left > 0 else 0.0
