"""Camera perception: EntityPerceptions of the vehicles in the cameras' images.

A vehicle is seen if it is in the image, closer than the horizon, and not hidden by the terrain; of what
stands on the ground, its position on the ground counts. Positions and velocities are true, without error.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import cos, degrees, hypot, pi
from typing import TYPE_CHECKING, Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.simulator import payload
from cratous.services.simulator.earth import EQUATOR_M, Place, bound_pi, horizon_m
from cratous.services.simulator.locations import location_of
from cratous.services.simulator.motion import Motion

if TYPE_CHECKING:
    from cratous.services.simulator.terrain import Terrain

MOST_ID = 2**32 - 1
"""Ids in perceptions have 32 bits, those of vehicles 64."""
MOST_PAYLOADS = 8


class Body(NamedTuple):
    """A vehicle: its id, motion and payloads."""

    id: int
    motion: Motion
    mounted: tuple[payload.Gimbal, ...]


def perceptions(
    bodies: Iterable[Body], time_ms: int, terrain: Terrain | None = None
) -> Iterator[Any]:
    """The present EntityPerceptions: for each vehicle, those that its cameras see, in order.

    A perceiving vehicle needs a 32-bit id, otherwise it reports nothing; a perceived one without gets the id
    0, unknown.
    """
    there = tuple(bodies)
    if len(there) < 2:
        return
    places = [(one.motion.lat_rad, one.motion.lon_rad, one.motion.alt_m) for one in there]
    for one in there:
        pictures = _pictures(one) if 0 < one.id <= MOST_ID else []
        if not pictures:
            continue
        lat, lon, alt = one.motion.lat_rad, one.motion.lon_rad, one.motion.alt_m
        for other, place in zip(there, places, strict=True):
            north, east, below = place[0] - lat, place[1] - lon, alt - place[2]
            if abs(east) > pi:
                east = bound_pi(east)
            by = []
            for number, (a0, a1, a2), (r0, r1, r2), (d0, d1, d2), wide, high in pictures:
                depth = north * a0 + east * a1 + below * a2
                if (
                    depth > 0
                    and abs(north * r0 + east * r1 + below * r2) <= wide * depth
                    and abs(north * d0 + east * d1 + below * d2) <= high * depth
                ):
                    by.append(number)
            if by and other is not one and _in_sight(one.motion, place, terrain):
                yield _perception(one.id, by, other, time_ms)


class _Picture(NamedTuple):
    """A camera's image, by its id: the axes ahead, right and down as components for latitude, longitude [rad]
    and height [m] below; half of its width and height at depth 1.
    """

    number: int
    ahead: Place
    right: Place
    down: Place
    wide: float
    high: float


def _pictures(one: Body) -> list[_Picture]:
    """The images of a vehicle's cameras."""
    found = []
    around = EQUATOR_M * cos(one.motion.lat_rad)
    for g in one.mounted:
        for c in g.cameras:
            *axes, wide, high = payload.picture(g, c, one.motion)
            ahead, right, down = ((x * EQUATOR_M, y * around, z) for x, y, z in axes)
            number = c.configuration.PayloadID
            found.append(_Picture(number, ahead, right, down, wide, high))
    return found


def _in_sight(m: Motion, place: Place, terrain: Terrain | None) -> bool:
    """Whether neither the horizon nor the terrain hides a place from a vehicle."""
    north = (place[0] - m.lat_rad) * EQUATOR_M
    east = bound_pi(place[1] - m.lon_rad) * EQUATOR_M * cos(m.lat_rad)
    if hypot(north, east) > horizon_m(m.alt_m) + horizon_m(place[2]):
        return False
    if terrain is None:
        return True
    from cratous.services.simulator.sight import in_sight

    return in_sight(terrain, m, place)


def _perception(perceiver: int, by: list[int], seen: Body, time_ms: int) -> Any:
    m = seen.motion
    return lmcp.new(
        "EntityPerception",
        PerceivedEntityID=seen.id if 0 < seen.id <= MOST_ID else 0,
        PerceiverID=perceiver,
        PerceiverPayloads=[n for n in by if 0 <= n <= MOST_ID][:MOST_PAYLOADS],
        Velocity=[m.north_m_s, m.east_m_s, -m.climb_m_s],
        VelocityValid=True,
        Attitude=[degrees(m.heading_rad), degrees(m.pitch_rad), degrees(m.roll_rad)],
        AttitudeValid=True,
        Location=location_of(m),
        TimeLastSeen=time_ms,
    )
