"""The dialects of the text protocol that need no keys, and the line format of the thesis.

`cratous` is ours. `original` is that of the programs whose sources are public: ours without HELLO, HBEAT, AGAIN,
NOCMD, OTHER, OVELO, epochs and the numbers of route requests. `thesis` is that of the thesis on CRATOUS: a line
begins with a tag of exactly five letters, the first field follows at once, labels are read in capitals and in small
letters, an integer may have no `.0`, and waypoints count from 1. The thesis gives the tags WAYPT, GEOFN, POSTN,
ATTUD, OBJCT, COMND, WPRCH and WPREQ and the fields of WAYPT; other fields and words are taken from the original's
programs, and tags of six letters lose the last one.
"""

from __future__ import annotations

from dataclasses import replace
from enum import Enum

from cratous.bridge.text_protocol.layouts import LAYOUTS, ORIGINAL_LIMITS, FieldLayout, Layout
from cratous.bridge.text_protocol.messages import (
    GoToWaypoint,
    Message,
    Waypoint,
    WaypointReached,
)


class Dialect(Enum):
    """The dialect in which lines are written and read."""

    CRATOUS = "cratous"
    ORIGINAL = "original"
    THESIS = "thesis"

    @property
    def ours(self) -> bool:
        """True if the peer knows HELLO, HBEAT, AGAIN, NOCMD, EPOCH, OTHER, OVELO and epochs, and can be asked for
        routes."""
        return self is Dialect.CRATOUS

    @property
    def part_waypoints(self) -> int | None:
        """The most waypoints that a peer can hold; a longer plan is sent to it in parts."""
        return ORIGINAL_LIMITS.waypoints if self is Dialect.ORIGINAL else None


TAG_LETTERS = 5
WAYPOINT_ORDER = ("total", "index", "lat", "long", "alt", "speed")
"""The order of the fields of WAYPT in the thesis's example."""
_COUNTS_WAYPOINTS = {Waypoint: "index", WaypointReached: "id", GoToWaypoint: "id"}


def _field(layout: Layout, field: FieldLayout) -> FieldLayout:
    counts = _COUNTS_WAYPOINTS.get(layout.message) == field.label
    return replace(field, first=1) if counts else field


def _of_thesis(layout: Layout) -> Layout:
    fields = [_field(layout, field) for field in layout.fields]
    if layout.message is Waypoint:
        fields.sort(key=lambda field: WAYPOINT_ORDER.index(field.label))
    return replace(layout, tag=layout.tag[:TAG_LETTERS], fields=tuple(fields))


THESIS_LAYOUTS: tuple[Layout, ...] = tuple(map(_of_thesis, LAYOUTS))
_TAGS = {layout.tag for layout in LAYOUTS}
_LABELS: dict[str, tuple[str, ...]] = {}
for _layout in THESIS_LAYOUTS:
    _form = ("type",) if _layout.form else ()
    _own = (*_form, *(field.label.lower() for field in _layout.fields))
    _LABELS[_layout.tag] = (*_LABELS.get(_layout.tag, ()), *_own)
assert len(_LABELS) == len(_TAGS)  # five letters distinguish them all

LAYOUTS_OF: dict[Dialect, tuple[Layout, ...]] = {
    Dialect.CRATOUS: LAYOUTS,
    Dialect.ORIGINAL: LAYOUTS,
    Dialect.THESIS: THESIS_LAYOUTS,
}
LAYOUT_IN: dict[Dialect, dict[type[Message], Layout]] = {
    dialect: {layout.message: layout for layout in layouts}
    for dialect, layouts in LAYOUTS_OF.items()
}


def has_comma_after_tag(line: str) -> bool:
    """True for a line that begins with a tag and a comma, as in all dialects but the thesis's."""
    tag, comma, _ = line.partition(",")
    return bool(comma) and tag in _TAGS


def has_label_after_tag(line: str) -> bool:
    """True for a line that begins with a tag of five letters and a label of its message, as in the thesis's dialect."""
    labels = _LABELS.get(line[:TAG_LETTERS])
    return labels is not None and line[TAG_LETTERS:].lower().startswith(labels)
