"""Zones as the judge uses them, from a log or a mission file, which stand or move straight.

In a log standing regions stand for a moving zone too, which vehicles need not keep: they are left out, and the zone
itself is checked where it is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from cratous.judge.fields import Node
from cratous.judge.plane import fault_of_ring
from cratous.spec.errors import BadInput

Point = tuple[float, float]


@dataclass(frozen=True)
class Zone:
    """A polygon (north, east) between two altitudes, known from an instant on, and until one if it ends.
    padding_m enlarges a keep-out and reduces a keep-in, by distance. velocity_m_s: north, east; from_ms: when it is
    where its ring says, if it moves."""

    id: int
    keep_in: bool
    ring: tuple[Point, ...]
    floor_m: float
    ceiling_m: float
    padding_m: float = 0.0
    from_ms: int = 0
    until_ms: int | None = None
    velocity_m_s: Point = (0.0, 0.0)

    def over(self, time_ms: int) -> bool:
        """Whether it has ended, and applies to no leg that begins at time_ms."""
        return self.until_ms is not None and time_ms >= self.until_ms


def zone(data: Node, from_ms: int = 0) -> Zone:
    """A zone; BadInput if its outline is no simple polygon."""
    found = Zone(
        data["id"].whole,
        data["kind"].one_of("keep_in", "keep_out") == "keep_in",
        tuple(pair(v) for v in data["vertices"]),
        data["floor_m"].real,
        data["ceiling_m"].real,
        data["padding_m"].real,
        from_ms,
    )
    refuse_bad_ring(found.ring, data["vertices"])
    if found.padding_m < 0:
        raise data["padding_m"].wrong("0 or more")
    return found


def with_ends(zones: Sequence[Zone], ends: Sequence[tuple[Node, int]]) -> tuple[Zone, ...]:
    """The zones with their end times, if any; BadInput for an end of an unknown zone.

    ends: the id of a zone, and its end time [ms]."""
    known, until = {one.id: one.from_ms for one in zones}, dict[int, int]()
    for number, at in ends:
        if number.whole in until or at <= known.get(number.whole, at):
            raise number.wrong("a zone that is known by then, once")
        until[number.whole] = at
    return tuple(replace(one, until_ms=until.get(one.id)) for one in zones)


def refuse_bad_ring(ring: tuple[Point, ...], data: Node) -> None:
    """BadInput if these corners are not a simple polygon."""
    fault = fault_of_ring(ring)
    if fault:
        raise BadInput(
            f"not a simple polygon: {fault}",
            where=data.where,
            item=data.item,
            expected="at least three corners, and edges that meet nowhere else",
        )


def pair(data: Node) -> Point:
    """Two numbers."""
    found = tuple(x.real for x in data)
    if len(found) != 2:
        raise data.wrong("two numbers")
    return found[0], found[1]


def moves(data: Node) -> bool:
    """Whether a zone of a mission file moves."""
    return data.has("velocity_m_s")


def moved(one: Zone, velocity: Node, until_ms: int | None) -> Zone:
    """The zone with this velocity; BadInput for a keep-in, or a zone that ends before it is in force."""
    if one.keep_in:
        raise velocity.wrong("a keep-out")
    found = replace(one, velocity_m_s=pair(velocity), until_ms=until_ms)
    if (until_ms is not None and until_ms <= one.from_ms) or not any(found.velocity_m_s):
        raise velocity.wrong("a velocity, until later than from when the zone is in force")
    return found


def drifting(data: Node) -> dict[int, Zone]:
    """The moving zones of a mission in a log by id, each once; BadInput if its regions name different ones."""
    found = dict[int, Zone]()
    for region in _regions(data):
        moving, kind = region["moving"], region["kind"].data
        until = moving["until_ms"]
        plain = {
            "id": moving["id"].data,
            "kind": kind,
            "vertices": moving["vertices"].data,
            "floor_m": moving["floor_m"].data,
            "ceiling_m": moving["ceiling_m"].data,
            "padding_m": 0.0,
        }
        one = zone(Node(plain, moving.where, moving.item), moving["from_ms"].whole)
        one = moved(one, moving["velocity_m_s"], None if until.data is None else until.whole)
        if found.setdefault(one.id, one) != one:
            raise moving.wrong("one moving zone of this id")
    return found


def _regions(data: Node) -> Iterator[Node]:
    for one in data["zones"]:
        if one.has("moving"):
            yield one
    for change in data["changes"]:
        if change["kind"].data == "zone" and change["zone"].has("moving"):
            yield change["zone"]
