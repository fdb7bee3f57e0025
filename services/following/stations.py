"""The circle of each vehicle of a task around an entity, and whether the vehicle does what the task requires
there.

A station is a circle; vehicles of one task have different ones. Around the same centre, each is RING_M wider
than the one before; side by side, the centres are two radii and RING_M apart. The kernels decide whether a
vehicle is there.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.core.tasks.rendezvous import pace
from cratous.core.tasks.stations import beside, in_ring
from cratous.services.following.meeting import Look, first_met, narrowed
from cratous.services.following.motion import Motion
from cratous.services.following.task_parameters import Asked, Tower
from cratous.services.loading.coordinates import Places
from cratous.services.mission.sensor import sees
from cratous.services.planning.performance_classes import Flyer, camera_for
from cratous.services.planning.point_paths import tilted
from cratous.spec.mission import Camera

RING_M = 150.0
"""Least distance between the circles of two vehicles of a task [m]."""

FLY, EARLY, LATE = 0, 1, 2
"""Results of `pace`."""

LEAST_TILT_RAD = 0.01
"""Smallest depression angle assumed for a camera [rad]."""


class Station(NamedTuple):
    """A circle: its centre, north and east [m], and its radius [m]."""

    at: Vec2
    radius_m: float


def camera_of(asked: Asked, flyer: Flyer) -> Camera | None:
    """The camera that views the target; None if the task needs no view or the vehicle has no camera."""
    return None if asked.looks is None else camera_for(asked.looks, flyer.cameras)


def station(asked: Asked, slot: int, flyer: Flyer, there: Motion, terrain_m: float) -> Station:
    """The circle of a slot, from 0, around an entity at the position of its motion."""
    return _circle(asked, slot, _radius_m(asked, flyer, terrain_m), there)


def _radius_m(asked: Asked, flyer: Flyer, terrain_m: float) -> float:
    """Radius of the circle of slot 0 [m]."""
    radius = flyer.radius_m
    if asked.kind in ("BlockadeTask", "EscortTask") or asked.tower is not None:
        return radius
    assert asked.looks is not None
    for view in tilted(asked.looks, camera_of(asked, flyer)):
        # a camera that cannot look down sees the centre only from a wide circle
        tilt = max(-view.elevation_rad, LEAST_TILT_RAD)
        radius = max(radius, (flyer.alt_m - terrain_m) / math.tan(tilt))
    return radius


def _circle(asked: Asked, slot: int, radius: float, there: Motion) -> Station:
    """The circle of a slot; radius: that of slot 0 [m]."""
    if asked.kind == "BlockadeTask":
        return Station(_between(asked, slot, radius, there), radius)
    if asked.tower is not None:
        return Station(there.at, radius)  # its motion is that of the midpoint
    if asked.kind == "EscortTask":
        return Station(there.ahead(asked.standoff_m), radius)
    return Station(there.at, radius + slot * RING_M)


def reached_from(
    start: Vec2, asked: Asked, slot: int, flyer: Flyer, motion: Motion, terrain_m: float
) -> tuple[Motion, float] | None:
    """The entity's motion when a vehicle in straight flight reaches its station, and the distance that it has
    flown by then [m]; None if it does not reach it.
    """
    radius = _radius_m(asked, flyer, terrain_m)

    def at_time(seconds: float) -> tuple[Motion, float]:
        there = motion._replace(at=motion.after(seconds))
        return there, _way_m(asked, start, there, _circle(asked, slot, radius, there))

    def look(seconds: float) -> Look:
        left_m = at_time(seconds)[1]
        said = pace(left_m, seconds, flyer.speed_m_s, flyer.speed_m_s, 0.0)
        return Look(bool(said.act == LATE), left_m - flyer.speed_m_s * seconds)

    found_s = first_met(look, at_time(0.0)[1] / flyer.speed_m_s)
    return None if found_s is None else at_time(found_s)


def _way_m(asked: Asked, start: Vec2, there: Motion, goal: Station) -> float:
    """Distance to a circle's rim; for a relay, to where a whole turn is in range of both ends [m]."""
    far_m = max(math.dist(start, goal.at) - goal.radius_m, 0.0)
    if asked.tower is None:
        return far_m
    tower, other = asked.tower, _supported(asked.tower, there)
    reach_m = tower.range_m - goal.radius_m

    def look(from_m: float) -> Look:
        here = towards(start, goal.at, from_m)
        apart_m = max(math.dist(tower.at, here), math.dist(other, here))
        return Look(not relays(tower, there, here, goal.radius_m), apart_m - reach_m)

    begin, end = look(0.0), look(far_m)
    if end.short or not begin.short:
        return far_m if end.short else 0.0
    return narrowed(look, (0.0, begin), (far_m, end))


def towards(start: Vec2, goal: Vec2, far_m: float) -> Vec2:
    """The point far_m [m] from `start` on the straight line to `goal`."""
    share = far_m / (math.dist(start, goal) or 1.0)
    return Vec2(start.x + share * (goal.x - start.x), start.y + share * (goal.y - start.y))


def _between(asked: Asked, slot: int, radius_m: float, there: Motion) -> Vec2:
    """The point between an entity and the protected place, or ahead of the entity, offset sideways by slot."""
    north, east = there.velocity
    far_m = asked.standoff_m
    if asked.protected is not None:
        north, east = asked.protected.x - there.at.x, asked.protected.y - there.at.y
        far_m = min(far_m, math.hypot(north, east))
    length = math.hypot(north, east)
    north, east = (1.0, 0.0) if length == 0 else (north / length, east / length)
    aside_m = (slot + 1) // 2 * (2 * radius_m + RING_M) * (1 if slot % 2 else -1)
    return Vec2(
        there.at.x + far_m * north - aside_m * east, there.at.y + far_m * east + aside_m * north
    )


def at_station(
    asked: Asked, slot: int, state: Any, here: Vec2, goal: Station, there: Motion, places: Places,
    camera: Camera | None,
) -> bool:  # fmt: skip
    """Whether a vehicle, according to its state, does what its task requires.

    Watch: a footprint of its camera contains the entity, within two radii of its circle. Escort: within that
    distance of its circle's centre. Blockade: within two radii of the line between the entity and the
    protected place, on its side; without such a place, of its own circle's centre. Relay: within the tower's
    range of both the tower and what is supported.
    """
    if asked.tower is not None:
        return relays(asked.tower, there, here)
    reach_m = 2 * goal.radius_m
    if asked.watches and (camera is None or not _seen(state, camera, there.at, places)):
        return False
    if asked.watches:
        return in_ring(there.at, here, 0, reach_m)
    if asked.protected is None:
        return in_ring(goal.at, here, 0, reach_m)
    aside_m = (slot + 1) // 2 * (2 * goal.radius_m + RING_M)
    return beside(here, there.at, asked.protected, reach_m + aside_m)


def relays(tower: Tower, middle: Motion, here: Vec2, spare_m: float = 0.0) -> bool:
    """Whether a place is in range of the tower and of what is supported, by a margin of spare_m [m].

    middle: motion of the midpoint between the two.
    """
    reach_m = max(tower.range_m - spare_m, 0.0)
    supported = _supported(tower, middle)
    return in_ring(tower.at, here, 0, reach_m) and in_ring(supported, here, 0, reach_m)


def _supported(tower: Tower, middle: Motion) -> Vec2:
    """The place of what is supported, from that of the midpoint between it and the tower."""
    return Vec2(2 * middle.at.x - tower.at.x, 2 * middle.at.y - tower.at.y)


def _seen(state: Any, camera: Camera, at: Vec2, places: Places) -> bool:
    """Whether the footprint that a state reports for a camera contains a place."""
    for payload in state.PayloadStateList:
        footprint = getattr(payload, "Footprint", None)
        if footprint is None or len(footprint) < 3 or payload.PayloadID != camera.camera_id:
            continue
        quad = tuple(places.local(p.Latitude, p.Longitude) for p in footprint)
        if all(math.isfinite(x) for corner in quad for x in corner):
            return sees(quad, (at.x, at.y))
    return False
