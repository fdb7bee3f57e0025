"""What a page is made of, before it is HTML or PDF: plain data, the same for both."""

from __future__ import annotations

from typing import NamedTuple

from cratous.services.full_report.shapes import Shape

NOT_ASKED, NOT_OBSERVED = "not asked for", "not observed"
DASH = "–"
VERDICTS = {
    "holds": "holds", "proved": "holds", "held": "holds", "supported": "holds",
    "violated": "violated", "broken": "violated",
    "unknown": "unknown", "excused": "unknown", "not observed": "unknown",
}  # fmt: skip
"""Cells that say one of these are drawn in the colour of that verdict."""


class Words(NamedTuple):
    """A paragraph. kind: text, soft, alarm, code, item (of a list) or a verdict (a banner in its colour)."""

    text: str
    kind: str = "text"


class Head(NamedTuple):
    """A heading inside a section."""

    text: str


class Table(NamedTuple):
    """head: of the columns; rows: a text for each column, whose lines after the first are softer; shares:
    of the width, by column; numbers: the columns that stand to the right; empty: what is said where no
    row is, instead of a table."""

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    shares: tuple[float, ...]
    numbers: tuple[int, ...] = ()
    empty: str = NOT_OBSERVED


class Picture(NamedTuple):
    """A drawing in units of its own, y downwards, cut at its frame; caption: pairs of a text and the
    style of the line that it explains, empty for none."""

    title: str
    width: float
    height: float
    shapes: tuple[Shape, ...]
    caption: tuple[tuple[str, str], ...] = ()


class Beside(NamedTuple):
    """A large picture on the left, and smaller ones beside it."""

    left: Picture
    right: tuple[Picture, ...]


Part = Words | Head | Table | Picture | Beside


class Section(NamedTuple):
    """name: of its address in the page; title: with its number; parts: in their order."""

    name: str
    title: str
    parts: tuple[Part, ...]


class Document(NamedTuple):
    """title: of the whole; about: a line below it; sections: each begins a page of its own in print."""

    title: str
    about: str
    sections: tuple[Section, ...]
