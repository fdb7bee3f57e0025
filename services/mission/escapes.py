"""Ways that a vehicle can fly at once where a zone has appeared before it: a turn as tight as it can, then straight on.

Points and turns are those of the aircraft in flight, one for each step of it, so that what is found is flown as it
is: the fastest level turn at its greatest bank in each step, at the speed that it has or slowing down. To
either side, by all angles up to a whole turn, and of these straight on by some lengths. Which of the legs break a
zone the proved kernels answer; whether an aircraft has no way at all, no number of ways tried can say.
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
"""Straight on it is looked at so many pieces,"""
PIECE = 0.25
"""each so many turn radii long;"""
ENDS = frozenset((0, 1, 2, 4, 8, 16, 32))
"""and behind so many of them a way may end."""


class Escape(NamedTuple):
    """points: from where the vehicle is, one for each step in the turn; end: the pose there; turn_rad: to the right,
    below 0 to the left; speed_m_s: that is commanded from the start and reached by the end of the turn; broken_m:
    length of the legs that break a zone; length_m: of all."""

    points: tuple[Position, ...]
    end: Pose
    turn_rad: float
    speed_m_s: float
    broken_m: float
    length_m: float

    @property
    def words(self) -> str:
        """What is flown, in words."""
        if not self.turn_rad:
            return "straight on"
        side = {1.0: "right", -1.0: "left"}[math.copysign(1.0, self.turn_rad)]
        return f"a turn of {abs(math.degrees(self.turn_rad)):.0f} deg to the {side}"


class _Flown(NamedTuple):
    """So far: the pose, its speed [m/s], the points, and how much was flown and is broken [m]."""

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
    """All ways tried from a pose at a speed over the ground. vehicle: as it is able in the wind; zones: to keep, without
    padding; dt_s: a step of the flight [s]. One that stands has none."""
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
    """After each step of a turn, how far it has turned; at first not at all."""
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
    """Ways that go straight on behind a turn."""
    piece_m = PIECE * turn_radius_m(flown.speed_m_s, vehicle.max_bank_rad)
    for k in range(PIECES + 1):
        if k in ENDS:
            last = flown.at._replace(heading_rad=math.remainder(flown.at.heading_rad, 2 * math.pi))
            yield Escape(
                flown.points, last, turn_rad, flown.speed_m_s, flown.broken_m, flown.length_m
            )
        flown = flown.to(_on(flown.at, piece_m), flown.speed_m_s, zones)


def _on(at: Pose, way_m: float) -> Pose:
    """A pose so far straight on."""
    return at._replace(
        north_m=at.north_m + way_m * math.cos(at.heading_rad),
        east_m=at.east_m + way_m * math.sin(at.heading_rad),
    )
