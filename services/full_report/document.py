"""Content of a page, independent of HTML and PDF, as plain data."""

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
"""Cells with one of these texts are drawn in the colour of that verdict."""


class Words(NamedTuple):
    """A paragraph. kind: text, soft, alarm, code, item (of a list), or a verdict (a banner in its colour)."""

    text: str
    kind: str = "text"


class Head(NamedTuple):
    """A heading inside a section."""

    text: str


class Table(NamedTuple):
    """head: of the columns; rows: a text for each column, with lines after the first in a lighter
    ink; shares: of the width, by column; numbers: right-aligned columns; empty: text shown instead
    of a table without rows.
    """

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    shares: tuple[float, ...]
    numbers: tuple[int, ...] = ()
    empty: str = NOT_OBSERVED


class Picture(NamedTuple):
    """A drawing in its own units, y downwards, clipped to its frame; caption: pairs of a text and
    the line style that it explains, empty for none.
    """

    title: str
    width: float
    height: float
    shapes: tuple[Shape, ...]
    caption: tuple[tuple[str, str], ...] = ()


class Beside(NamedTuple):
    """A large picture on the left, with smaller ones beside it."""

    left: Picture
    right: tuple[Picture, ...]


Part = Words | Head | Table | Picture | Beside


class Section(NamedTuple):
    """name: its anchor in the page; title: with its number; parts: in order."""

    name: str
    title: str
    parts: tuple[Part, ...]


class Document(NamedTuple):
    """title: of the document; about: a line below it; sections: each starts a new page in print."""

    title: str
    about: str
    sections: tuple[Section, ...]
