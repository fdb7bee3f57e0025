"""What cameras see: EntityPerceptions of the vehicles that are in their pictures.

A vehicle is seen where it is in the picture, nearer than the horizon, and not hidden by the terrain; of what stands on the
ground that is the footprint. Places and velocities are the true ones, without error.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import cos, degrees, hypot, radians
from typing import TYPE_CHECKING, Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.simulator import payload
from cratous.services.simulator.earth import EQUATOR_M, Place, bound_pi, horizon_m
from cratous.services.simulator.motion import Motion

if TYPE_CHECKING:
    from cratous.services.simulator.terrain import Terrain

MOST_ID = 2**32 - 1
"""Ids of perceptions have 32 bits, those of vehicles 64."""
MOST_PAYLOADS = 8


class Body(NamedTuple):
    """A vehicle: its id, where and how it is, and what is mounted on it."""

    id: int
    motion: Motion
    mounted: tuple[payload.Gimbal, ...]


def perceptions(
    bodies: Iterable[Body], time_ms: int, terrain: Terrain | None = None
) -> Iterator[Any]:
    """The EntityPerceptions of now: of each vehicle for each that its cameras see, in their order.

    A vehicle that sees has an id of 32 bits, or tells nothing; one that is seen and has none is told as 0, unknown.
    """
    there = tuple(bodies)
    if len(there) < 2:
        return
    for one in there:
        if not 0 < one.id <= MOST_ID:
            continue
        pictures = [
            (c.configuration.PayloadID, payload.picture(g, c, one.motion))
            for g in one.mounted
            for c in g.cameras
        ]
        if pictures:
            for other in there:
                if other.id == one.id:
                    continue
                by = _seen_by(one.motion, pictures, other.motion, terrain)
                if by:
                    yield _perception(one.id, by, other, time_ms)


def _seen_by(
    m: Motion, pictures: list[tuple[int, payload.Picture]], other: Motion, terrain: Terrain | None
) -> list[int]:
    """The cameras of a vehicle that see another."""
    north = (other.lat_rad - m.lat_rad) * EQUATOR_M
    east = bound_pi(other.lon_rad - m.lon_rad) * EQUATOR_M * cos(m.lat_rad)
    below = m.alt_m - other.alt_m
    by = []
    for number, (ahead, right, down, wide, high) in pictures:
        depth = north * ahead[0] + east * ahead[1] + below * ahead[2]
        if (
            depth > 0
            and abs(north * right[0] + east * right[1] + below * right[2]) <= wide * depth
            and abs(north * down[0] + east * down[1] + below * down[2]) <= high * depth
        ):
            by.append(number)
    if by and hypot(north, east) > horizon_m(m.alt_m) + horizon_m(other.alt_m):
        return []
    if by and terrain is not None:
        from cratous.services.simulator.sight import in_sight

        if not in_sight(terrain, m, (other.lat_rad, other.lon_rad, other.alt_m)):
            return []
    return by


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
        Location=lmcp.new(
            "Location3D",
            Latitude=degrees(m.lat_rad),
            Longitude=degrees(m.lon_rad),
            Altitude=m.alt_m,
            AltitudeType="MSL",
        ),
        TimeLastSeen=time_ms,
    )


def place_of(body: Any) -> Place:
    """Where an EntityPerception has its entity."""
    at = body.Location
    return radians(at.Latitude), radians(at.Longitude), at.Altitude
