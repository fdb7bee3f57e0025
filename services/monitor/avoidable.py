"""For a violated zone that appeared in flight: whether an escape path from there kept all zones.

A path that is found is checked exactly. If none of the paths tried keeps the zones, their number is
reported; that is no proof that none exists. The verdict is violated in either case.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from math import cos, sin
from typing import Any, NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import turn_radius_m
from cratous.core.routing.polylines import circle_points
from cratous.services.mission.escapes import Escape, escapes
from cratous.services.mission.zones import distance_m, exact_leg_ok
from cratous.spec.mission import Position, Vehicle, Zone
from cratous.spec.mission.plan import Pose

TRIED = (
    "turns to either side as tight as it can, as fast as it was or slowing down, then straight on "
    "and into a circle"
)
NEVER = 2.0
"""Speeds above this multiple of the maximum speed are implausible: no escape paths are tried from them."""


class Appeared(NamedTuple):
    """State of a vehicle when a zone appeared: time [ms], pose, and ground speed [m/s]."""

    at_ms: int
    pose: Pose
    speed_m_s: float


def avoidable(
    seen: Appeared, vehicle: Vehicle, zone: Zone, zones: Sequence[Zone], dt_s: float
) -> tuple[str, dict[str, Any]]:
    """Whether an escape path kept the zones then active, in words and as data.

    vehicle: with its performance in the wind; zone: the violated one, among zones; dt_s: time step
    of the flight [s].
    """
    here = Position(*seen.pose[:3])
    kept = [one for one in zones if exact_leg_ok(here, here, one)]
    away_m = distance_m((here,), zone)
    text = f"when it appeared at {seen.at_ms / 1000:.2f} s it was {away_m:.0f} m away"
    data: dict[str, Any] = {"appeared_ms": seen.at_ms, "away_m": round(away_m, 2)}
    if not 0 < seen.speed_m_s <= NEVER * vehicle.max_speed_m_s:
        moved = f"flew at {seen.speed_m_s:.0f} m/s" if seen.speed_m_s else "did not move"
        return f"{text} and {moved}: no way was tried from there", data
    tried, found = 0, None
    for way in escapes(seen.pose, seen.speed_m_s, vehicle, kept, dt_s):
        tried += 1
        if way.broken_m == 0 and _keeps(way, vehicle, kept):
            found = way
            break
    if found is None:
        text += f": none of {tried} ways tried from there keeps the zones ({TRIED})"
    else:
        text += f": {found.words} and a circle would have kept the zones"
    data |= {"ways_tried": tried, "way_kept": None if found is None else found.words}
    return text, data


def _keeps(way: Escape, vehicle: Vehicle, zones: Sequence[Zone]) -> bool:
    """Whether a path followed by a circle to either side at its end keeps the zones, checked exactly."""
    radius_m, end = turn_radius_m(way.speed_m_s, vehicle.max_bank_rad), way.end
    for side in (1, -1):
        centre = (
            end.north_m - side * radius_m * sin(end.heading_rad),
            end.east_m + side * radius_m * cos(end.heading_rad),
        )
        lap = circle_points(centre, radius_m, side == 1, way.points[-1])
        legs = itertools.pairwise((*way.points, *lap[1:]))
        if first_bad_leg(lap, zones) is None and all(
            exact_leg_ok(*leg, zone) for leg in legs for zone in zones
        ):
            return True
    return False
