"""Immediate escape paths where a zone has appeared ahead of a vehicle: the tightest turn, then straight on.

Points and turns are those of the aircraft in flight, one per step, so that a path is flown exactly as found:
the fastest level turn at the greatest bank in each step, at the present speed or slowing down; to either
side, by all angles up to a full turn, each followed by straight segments of several lengths. Proved kernels
decide which legs violate a zone; that an aircraft has no path at all cannot be shown by any number of
attempts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import turn_radius_m
from cratous.services.mission.landing import MAX_ACCELERATION_M_S2
from cratous.spec.mission import Position, Vehicle, Zone
from cratous.spec.mission.plan import Pose

PIECES = 32
"""Number of straight pieces examined,"""
PIECE = 0.25
"""length of each in turn radii,"""
ENDS = frozenset((0, 1, 2, 4, 8, 16, 32))
"""and numbers of pieces after which a path may end."""


class Escape(NamedTuple):
    """points: from the vehicle's position on, one per step in the turn; end: final pose; turn_rad: positive
    to the right; speed_m_s: commanded from the start and reached by the end of the turn; broken_m: length
    of the legs that violate a zone; length_m: total length.
    """

    points: tuple[Position, ...]
    end: Pose
    turn_rad: float
    speed_m_s: float
    broken_m: float
    length_m: float

    @property
    def words(self) -> str:
        """The path in words."""
        if not self.turn_rad:
            return "straight on"
        side = {1.0: "right", -1.0: "left"}[math.copysign(1.0, self.turn_rad)]
        return f"a turn of {abs(math.degrees(self.turn_rad)):.0f} deg to the {side}"


class _Flown(NamedTuple):
    """A path so far: pose, speed [m/s], points, length flown and length in violation [m]."""

    at: Pose
    speed_m_s: float
    points: tuple[Position, ...]
    length_m: float = 0.0
    broken_m: float = 0.0

    def to(self, at: Pose, speed_m_s: float, zones: Sequence[Zone]) -> _Flown:
        leg = (self.points[-1], Position(at.north_m, at.east_m, at.alt_m))
        way_m = math.dist(*leg)
        broken_m = way_m if first_bad_leg(leg, zones) is not None else 0.0
        points = (*self.points, leg[1])
        return _Flown(at, speed_m_s, points, self.length_m + way_m, self.broken_m + broken_m)


def escapes(
    start: Pose, speed_m_s: float, vehicle: Vehicle, zones: Sequence[Zone], dt_s: float
) -> Iterator[Escape]:
    """All paths tried from a pose at a ground speed. None for a vehicle at rest.

    vehicle: with its limits in the wind; zones: to keep, without padding; dt_s: step of the flight [s].
    """
    if not speed_m_s:
        return
    here = _Flown(start, speed_m_s, (Position(start.north_m, start.east_m, start.alt_m),))
    slow_m_s = min(speed_m_s, vehicle.min_speed_m_s)
    for wanted in dict.fromkeys((speed_m_s, slow_m_s)):
        for side in (1, -1):
            for turned, flown in _turning(here, side, wanted, vehicle, zones, dt_s):
                if turned or side == 1:
                    yield from _ending(flown, side * turned, vehicle, zones)


def _turning(
    flown: _Flown,
    side: int,
    wanted_m_s: float,
    vehicle: Vehicle,
    zones: Sequence[Zone],
    dt_s: float,
) -> Iterator[tuple[float, _Flown]]:
    """The angle turned after each step of a turn, beginning with 0, and the path so far."""
    turned, at, speed = 0.0, flown.at, flown.speed_m_s
    while turned < 2 * math.pi:
        yield turned, flown
        by = speed / turn_radius_m(speed, vehicle.max_bank_rad) * dt_s
        turned, speed = turned + by, max(wanted_m_s, speed - MAX_ACCELERATION_M_S2 * dt_s)
        at = _on(at._replace(heading_rad=at.heading_rad + side * by), speed * dt_s)
        flown = flown.to(at, speed, zones)


def _ending(
    flown: _Flown, turn_rad: float, vehicle: Vehicle, zones: Sequence[Zone]
) -> Iterator[Escape]:
    """Paths that continue straight after a turn."""
    piece_m = PIECE * turn_radius_m(flown.speed_m_s, vehicle.max_bank_rad)
    for k in range(PIECES + 1):
        if k in ENDS:
            last = flown.at._replace(heading_rad=math.remainder(flown.at.heading_rad, 2 * math.pi))
            yield Escape(
                flown.points, last, turn_rad, flown.speed_m_s, flown.broken_m, flown.length_m
            )
        flown = flown.to(_on(flown.at, piece_m), flown.speed_m_s, zones)


def _on(at: Pose, way_m: float) -> Pose:
    """The pose way_m [m] straight ahead."""
    return at._replace(
        north_m=at.north_m + way_m * math.cos(at.heading_rad),
        east_m=at.east_m + way_m * math.sin(at.heading_rad),
    )
