"""Lines, discs and labels of a picture, and their styles."""

from __future__ import annotations

from typing import NamedTuple

Place = tuple[float, float]


class Line(NamedTuple):
    """A polyline; closed: back to its start, and filled if its style has a fill."""

    places: tuple[Place, ...]
    style: str
    closed: bool = False


class Disc(NamedTuple):
    """A circle."""

    at: Place
    radius: float
    style: str


class Label(NamedTuple):
    """A text. anchor: start, middle or end; soft: in a lighter ink."""

    at: Place
    text: str
    anchor: str = "start"
    soft: bool = False


Shape = Line | Disc | Label


class Ink(NamedTuple):
    """stroke, fill: colours as #rrggbb, empty for none; width: of the line; dash: its pattern; opacity:
    of line and fill."""

    stroke: str = ""
    width: float = 1.0
    fill: str = ""
    dash: tuple[float, ...] = ()
    stroke_opacity: float = 1.0
    fill_opacity: float = 1.0
    round_ends: bool = False


COLOURS = ("#1864ab", "#0b7285", "#6741d9", "#2b8a3e", "#a61e4d", "#5f3dc4")
TEXT, SOFT, RULE, ICAROUS, BAD, GOOD = (
    "#1b2430", "#4a5563", "#d9dfe5", "#d9480f", "#b3261e", "#1f7a4d",
)  # fmt: skip
WAIT, TRANSIT = "#e0a800", "#b6c2cd"
STYLES = {
    "rule": Ink(RULE), "ink": Ink(TEXT, 2.0), "needle": Ink(fill=TEXT),
    "keep_out": Ink(BAD, 1.5, BAD, fill_opacity=0.16),
    "keep_in": Ink(GOOD, 2.0, dash=(10.0, 5.0)),
    "threshold": Ink(BAD, dash=(6.0, 4.0)),
    "hold": Ink(WAIT, 1.5, dash=(4.0, 3.0)), "site": Ink(GOOD, 2.0),
    "traffic": Ink(SOFT, 2.0, dash=(2.0, 4.0)),
    "taskline": Ink(TEXT, 9.0, stroke_opacity=0.3, round_ends=True),
    "taskpoint": Ink(TEXT, 2.0),
    "icarous": Ink(ICAROUS, 5.0, round_ends=True),
    "takeover": Ink(ICAROUS, 3.0, "#ffffff"),
    "bar transit": Ink(fill=TRANSIT), "bar wait": Ink(fill=WAIT), "bar task": Ink(fill=COLOURS[0]),
    "bar icarous": Ink(fill=ICAROUS), "bar return": Ink(ICAROUS, 1.0, TRANSIT, (3.0, 2.0)),
    **{f"planned {k}": Ink(c, 1.5, dash=(3.0, 5.0), stroke_opacity=0.55) for k, c in enumerate(COLOURS)},
    **{f"track {k}": Ink(c, 2.5, round_ends=True) for k, c in enumerate(COLOURS)},
    **{f"start {k}": Ink(fill=c) for k, c in enumerate(COLOURS)},
    **{
        f"footprint {k}": Ink(c, 0.5, c, stroke_opacity=0.25, fill_opacity=0.06)
        for k, c in enumerate(COLOURS)
    },
}  # fmt: skip
"""Ink by style name; a number in it is that of a vehicle, modulo the number of colours."""
FONT_SIZE = 13.0
"""Font size of labels, in drawing units."""


def places(text: str) -> tuple[Place, ...]:
    """The points of a polyline's `points` attribute."""
    pairs = (pair.split(",") for pair in text.split())
    return tuple((float(x), float(y)) for x, y in pairs)


def box(x: float, y: float, width: float, height: float) -> tuple[Place, ...]:
    """The corners of a rectangle."""
    return ((x, y), (x + width, y), (x + width, y + height), (x, y + height))
