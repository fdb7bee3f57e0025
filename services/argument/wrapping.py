"""Breaks text into lines of a given width without font files: the same lines on every machine.

Widths are those of DejaVu Sans, rounded up, which is wider than Arial, Helvetica and Verdana: what
fits here fits with these. Characters that are not in the table count as a square.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import NamedTuple

SIZE, LINE = 11.0, 14.0
"""Font size and line spacing."""
BOLD = 1.27
"""Upper bound of the width of bold text relative to regular text."""
FIRST = 32
HUNDREDTHS = (
    32, 41, 46, 84, 64, 96, 78, 28, 40, 40, 50, 84, 32, 37, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64,
    64, 64, 34, 34, 84, 84, 84, 54, 100, 69, 69, 70, 78, 64, 58, 78, 76, 30, 30, 66, 56, 87, 75, 79,
    61, 79, 70, 64, 62, 74, 69, 99, 69, 62, 69, 40, 34, 40, 84, 50, 50, 62, 64, 55, 64, 62, 36, 64,
    64, 28, 28, 58, 28, 98, 64, 62, 64, 64, 42, 53, 40, 64, 60, 82, 60, 60, 53, 64, 34, 64, 84,
)  # fmt: skip
"""Width of each character from FIRST on, in hundredths of the font size."""
WIDEST, LONGEST = 180.0, 12
"""A word that may be wider than this is broken, at punctuation or otherwise after this many
letters: that many of the widest bold letters are no wider.
"""


class Line(NamedTuple):
    """One line as drawn."""

    text: str
    bold: bool = False


def width(text: str, *, bold: bool = False) -> float:
    """An upper bound of a text's width, in drawing units."""
    return _wide(_hundredths(text), bold)


def _hundredths(text: str) -> int:
    units = 0
    for c in text:
        place = ord(c) - FIRST
        units += HUNDREDTHS[place] if 0 <= place < len(HUNDREDTHS) else 100
    return units


def _wide(units: int, bold: bool) -> float:
    return units * SIZE / 100 * (BOLD if bold else 1.0)


class _Piece(NamedTuple):
    """Preceding space (omitted at the start of a line), the piece of text, and the width of both in hundredths."""

    before: str
    text: str
    space: int
    units: int


@lru_cache(maxsize=256)  # one text is tried in circles of many sizes
def _pieces(text: str) -> tuple[_Piece, ...]:
    """Words, with long ones split into parts that may be on separate lines."""
    found = []
    for word in text.split():
        parts = [word]
        if width(word, bold=True) > WIDEST:
            marked = re.findall(r"[^-_./;:,]*[-_./;:,]|[^-_./;:,]+", word)
            parts = [m[i : i + LONGEST] for m in marked for i in range(0, len(m), LONGEST)]
        for number, part in enumerate(parts):
            before = " " if not number else ""
            found.append(_Piece(before, part, _hundredths(before), _hundredths(part)))
    return tuple(found)


def least_width(line: Line) -> float:
    """Minimum total width of a paragraph's lines, wherever it is broken, in drawing units."""
    return sum(_wide(piece.units, line.bold) for piece in _pieces(line.text))


def wrapped(
    paragraphs: Iterable[Line], fits: Callable[[int], float], most: int | None = None
) -> list[Line] | None:
    """The lines of some paragraphs; None if more than `most` are needed, or a piece fits on no
    line.

    fits: maximum width of a line, by its number.
    """
    found: list[Line] = []
    for paragraph in paragraphs:
        line, units, bold = "", 0, paragraph.bold
        for piece in _pieces(paragraph.text):
            if line and _wide(units + piece.space + piece.units, bold) <= fits(len(found)):
                line += piece.before + piece.text
                units += piece.space + piece.units
                continue
            if line:
                found.append(Line(line, bold))
                if len(found) == most:  # more text is left
                    return None
            line, units = piece.text, piece.units
            if _wide(units, bold) > fits(len(found)):
                return None
        if line:
            found.append(Line(line, bold))
    return None if most is not None and len(found) > most else found
