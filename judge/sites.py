"""Places of a mission: landing sites, and the fix at which vehicles merge."""

from __future__ import annotations

from typing import NamedTuple

from cratous.judge.fields import Node


class Site(NamedTuple):
    """A disc on which vehicles may land: its centre, its ground [m MSL], its radius."""

    name: str
    north_m: float
    east_m: float
    ground_m: float
    radius_m: float


class Fix(NamedTuple):
    """A merge fix: name, place, the vehicles that merge there, their separation in time, radius of the entry zone."""

    name: str
    north_m: float
    east_m: float
    vehicles: frozenset[int]
    separation_ms: int
    entry_m: float


def fix_of(data: Node) -> Fix:
    """The merge fix as logged. BadInput if it is malformed."""
    north_m, east_m, entry_m = data.reals("north_m", "east_m", "entry_m")
    who = frozenset(one.whole for one in data["vehicles"])
    name, apart_ms = data["name"].text, data["separation_ms"].whole
    return Fix(name, north_m, east_m, who, apart_ms, entry_m)


def site_of(data: Node) -> Site:
    """The landing site as logged. BadInput if it is malformed."""
    numbers = data.reals("north_m", "east_m", "ground_m", "radius_m")
    return Site(data["name"].text, *numbers)
