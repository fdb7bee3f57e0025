"""Places of a mission: where vehicles may land, and the fix at which they merge."""

from __future__ import annotations

from typing import NamedTuple

from cratous.judge.fields import Node


class Site(NamedTuple):
    """A disc on which vehicles may land: its middle, its ground [m MSL], its radius."""

    name: str
    north_m: float
    east_m: float
    ground_m: float
    radius_m: float


class Fix(NamedTuple):
    """Where vehicles merge: its name and place, who passes it how far apart in time, and the radius of the entry zone."""

    name: str
    north_m: float
    east_m: float
    vehicles: frozenset[int]
    separation_ms: int
    entry_m: float


def fix_of(data: Node) -> Fix:
    """As the log has it; BadInput if it does not fit."""
    north_m, east_m, entry_m = data.reals("north_m", "east_m", "entry_m")
    who = frozenset(one.whole for one in data["vehicles"])
    name, apart_ms = data["name"].text, data["separation_ms"].whole
    return Fix(name, north_m, east_m, who, apart_ms, entry_m)


def site_of(data: Node) -> Site:
    """As the log has it; BadInput if it does not fit."""
    numbers = data.reals("north_m", "east_m", "ground_m", "radius_m")
    return Site(data["name"].text, *numbers)
