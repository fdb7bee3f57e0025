"""Beside a zone that appeared before a vehicle and was broken: whether a way from there was left that keeps all zones.

A way that is found is checked exactly. That none of those tried keeps the zones is said with their number: it is no
proof that there was none. The verdict is violated in either case.
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
"""So many times its fastest speed no vehicle flies: positions that say so are none to try ways from."""


class Appeared(NamedTuple):
    """How a vehicle flew when a zone appeared: the instant [ms], its pose, and its speed over the ground [m/s]."""

    at_ms: int
    pose: Pose
    speed_m_s: float


def avoidable(
    seen: Appeared, vehicle: Vehicle, zone: Zone, zones: Sequence[Zone], dt_s: float
) -> tuple[str, dict[str, Any]]:
    """In words and as data: what of the zones that bound then could be kept. vehicle: as it is able in the wind;
    zone: that was broken, one of them; dt_s: a step of the flight [s]."""
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
    """Whether a way with a circle to either side at its end keeps the zones, exactly."""
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
