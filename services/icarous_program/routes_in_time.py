"""Routes that UxAS requests from where the vehicle is: held against the traffic that the instance knows.

A route around the zones that begins at the vehicle is flown now, so what others fly meanwhile is predicted. If the
route, at the speed asked for, is not permitted against them, a way in time takes its place, with a speed for each leg.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import way_along
from cratous.core.avoidance.prediction import after, buffered
from cratous.core.avoidance.way_ahead import there_within
from cratous.core.ways_in_time.scene import Scene
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.permits import keeps_volume, way_is_clear
from cratous.services.icarous.return_to_path import flat
from cratous.services.icarous.route_end import TURN_MARGIN
from cratous.services.ways_in_time.asking import Asked, Outcome, way_in_time
from cratous.spec.mission import Daa, Position, Zone
from cratous.spec.mission.plan import Pose

HERE_S = 1.0
"""A request begins at the vehicle if its start is within this time of flight [s]."""
Leg = tuple[Position, float]
"""The end of a leg, and its speed [m/s]."""


class Sky(NamedTuple):
    """What the instance last sensed, the mission's parameters, and the clock that ends a search."""

    sensed: Sensed
    daa: Daa
    overdue: Callable[[], bool] | None = None


def begins_here(start: Pose, speed_m_s: float, sky: Sky) -> bool:
    """Whether a requested route begins where the vehicle is, with others in the air."""
    here = flat(sky.sensed.motion.position)
    place = flat(Position(*start[:3]))
    return bool(sky.sensed.intruders) and there_within(here, place, speed_m_s, HERE_S)


def refused_by(points: Sequence[Position], start: Pose, speed_m_s: float, sky: Sky) -> int | None:
    """The id of an intruder against which a route is not permitted if it is flown now; None if there is none."""
    motion = sky.sensed.motion._replace(
        position=Position(*start[:3]), heading_rad=start.heading_rad, speed_m_s=speed_m_s
    )
    pieces = way_along(motion, points[1:], math.inf).pieces
    for other in sky.sensed.intruders:
        if not (keeps_volume(pieces, other, sky.daa) and way_is_clear(pieces, other, sky.daa)):
            return other.id
    return None


def in_time(
    start: Pose, end: Position, speed_m_s: float, zones: tuple[Zone, ...], sky: Sky
) -> tuple[list[Leg], str]:
    """The legs of a way in time from a start, the first with no length, and the reason if there is none."""
    sensed, daa = sky.sensed, sky.daa
    ability = sensed.ability
    rate = ability.turn_rate_rad_s * sensed.motion.speed_m_s / speed_m_s / TURN_MARGIN
    motion = sensed.motion._replace(
        position=Position(*start[:3]), heading_rad=start.heading_rad, speed_m_s=speed_m_s
    )
    scene = Scene(
        zones, 0.0, sensed.intruders, buffered(daa.well_clear, daa.buffer), (daa.well_clear,)
    )
    asked = Asked(motion, end, ability._replace(turn_rate_rad_s=rate))
    found = way_in_time(asked, scene, overdue=sky.overdue)
    if found.outcome is not Outcome.PATH:
        return [], f"{found.outcome}: {found.reason}"
    legs = [(motion.position, speed_m_s)]
    for piece in found.pieces:
        v = piece.velocity
        legs.append((after(piece, piece.duration_s), math.hypot(v.north_m_s, v.east_m_s)))
    return legs, ""
