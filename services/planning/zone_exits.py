"""The shortest level way out of keep-out zones that contain a vehicle, or into keep-in zones that do not.

A zone can appear around a vehicle. The way is a turn followed by a straight line, at the present altitude,
even where a climb would be shorter. To reach a line, turning until straight towards it and then flying
straight is the shortest path of this turn radius, and leaving a convex keep-out zone crosses the line of one
of its edges; so one of these paths, two per edge, is the shortest. For all other zones, and for several, it
is the shortest found among these, turns towards corners, and `EVEN` further headings.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import LEFT, RIGHT, STRAIGHT, pose_after
from cratous.core.routing.visibility import start_point
from cratous.services.planning.zones import MARGIN_M
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import Pose

EVEN = 24
"""Number of evenly spread headings tried besides those across edges and to corners."""
CORNERS_MOST = 200
"""Above this total number of corners, only the even headings are tried."""
ARC_STEP_RAD = math.radians(5)
"""Largest angle of a leg in a turn [rad]."""
OUT_M = 0.5
"""Distance flown beyond the crossing of an edge [m]."""
CLEAR_M = (MARGIN_M + 2.0, 2.0)
"""How far the way continues beyond the edge, where there is room [m]."""


class WayOut(NamedTuple):
    """points: from the vehicle's position to where other routes begin; end: the pose there; inside_m: length
    inside the zones [m]; length_m: total length [m].
    """

    points: tuple[Position, ...]
    end: Pose
    inside_m: float
    length_m: float


class _Turn(NamedTuple):
    """A pose after a turn, its arc length [m] and the points on it."""

    pose: Pose
    arc_m: float
    points: tuple[Position, ...]


def entered(at: Position, zones: Sequence[Zone]) -> tuple[Zone, ...]:
    """The zones that a position violates."""
    return tuple(zone for zone in zones if first_bad_leg((at,), (zone,)) is not None)


def way_out(pose: Pose, radius_m: float, zones: Sequence[Zone]) -> WayOut | None:
    """The shortest level way found out of all zones that the pose violates, without entering others; ways
    with room to turn behind them take precedence. None if it violates none or no way out was found.

    zones: without padding; radius_m: turn radius [m].
    """
    left = entered(start_point(pose), zones)
    if not left:
        return None
    kept = tuple(zone for zone in zones if zone not in left)
    found = []
    for order, turn in enumerate(_turns(pose, radius_m, left, kept)):
        straight_m = _straight_m(turn.pose, left)
        if straight_m is not None:
            # rounded to centimetres: equal lengths are ordered by heading, not by rounding errors
            found.append((round(turn.arc_m + straight_m, 2), order, straight_m, turn))
    found.sort(key=lambda one: one[:2])
    # ways with room to turn behind them first: a gap between zones leads nowhere
    for room, (inside_m, _, straight_m, turn) in itertools.product((True, False), found):
        for clear_m in CLEAR_M:
            out, end = (
                pose_after(turn.pose, STRAIGHT, way_m, radius_m)
                for way_m in (straight_m, straight_m + clear_m)
            )
            inside = (start_point(turn.pose), start_point(out))
            beyond = (inside[1], start_point(end))
            if first_bad_leg(inside, kept) is not None or first_bad_leg(beyond, zones) is not None:
                continue
            if not room or _turns_on(end, radius_m, zones):
                points = (*turn.points, beyond[1])
                return WayOut(points, end, inside_m, turn.arc_m + straight_m + clear_m)
    return None


def _turns_on(pose: Pose, radius_m: float, zones: Sequence[Zone]) -> bool:
    """Whether a quarter turn to at least one side keeps the zones."""
    arcs = (
        [
            start_point(pose_after(pose, kind, k * ARC_STEP_RAD * radius_m, radius_m))
            for k in range(math.ceil(math.pi / 2 / ARC_STEP_RAD) + 1)
        ]
        for kind in (RIGHT, LEFT)
    )
    return any(first_bad_leg(arc, zones) is None for arc in arcs)


def _turns(
    pose: Pose, radius_m: float, left: Sequence[Zone], kept: Sequence[Zone]
) -> Iterator[_Turn]:
    """Turns to all headings, on either side, each ended by a zone to keep or by the way out."""
    for kind in (RIGHT, LEFT):
        sign = 1 if kind == RIGHT else -1
        angles = sorted(
            (sign * (heading - pose.heading_rad)) % (2 * math.pi)
            for heading in _headings(pose, sign * radius_m, left)
        )
        here, points, turned = pose, [start_point(pose)], 0.0
        for angle in angles:
            steps = math.ceil((angle - turned) / ARC_STEP_RAD)
            for k in range(1, steps + 1):
                at = turned + (angle - turned) * k / steps
                here = pose_after(pose, kind, at * radius_m, radius_m)
                points.append(start_point(here))
                leg = points[-2:]
                if first_bad_leg(leg, kept) is not None:
                    break
                if first_bad_leg(leg[1:], left) is None:
                    yield _Turn(here, at * radius_m, tuple(points))
                    break
            else:
                turned = angle
                yield _Turn(here, turned * radius_m, tuple(points))
                continue
            break


def _headings(pose: Pose, radius_m: float, left: Sequence[Zone]) -> Iterator[float]:
    """Headings across the edges of zones, from the turn to their corners, and evenly spread. radius_m: of a
    turn to the right, negative to the left.
    """
    centre_n = pose.north_m - radius_m * math.sin(pose.heading_rad)
    centre_e = pose.east_m + radius_m * math.cos(pose.heading_rad)
    yield pose.heading_rad
    for k in range(EVEN):
        yield 2 * math.pi * k / EVEN
    if sum(len(zone.vertices) for zone in left) > CORNERS_MOST:
        return
    for zone in left:
        for (n, e), (n2, e2) in zip(
            zone.vertices, (*zone.vertices[1:], zone.vertices[0]), strict=True
        ):
            along = math.atan2(e2 - e, n2 - n)
            yield along + math.pi / 2
            yield along - math.pi / 2
            # along the tangent of the turn through the corner
            n, e = n - centre_n, e - centre_e
            ahead_m = math.sqrt(max(0.0, n * n + e * e - radius_m * radius_m))
            yield math.atan2(e, n) + math.atan2(radius_m, ahead_m)


def _straight_m(pose: Pose, left: Sequence[Zone]) -> float | None:
    """Straight distance from a pose to where it is out of all these zones [m], 0 if it is already; None if
    never.
    """
    if first_bad_leg((start_point(pose),), left) is None:
        return 0.0
    for crossing_m in sorted(_crossings_m(pose, left)):
        at = pose_after(pose, STRAIGHT, crossing_m + OUT_M, 1.0)
        if first_bad_leg((start_point(at),), left) is None:
            return crossing_m + OUT_M
    return None


def _crossings_m(pose: Pose, zones: Sequence[Zone]) -> Iterator[float]:
    """Straight distances to the crossings with the zones' edges [m]."""
    north, east = math.cos(pose.heading_rad), math.sin(pose.heading_rad)
    for zone in zones:
        beside = [
            (n - pose.north_m, e - pose.east_m) for n, e in (*zone.vertices, zone.vertices[0])
        ]
        across = [e * north - n * east for n, e in beside]
        ahead = [n * north + e * east for n, e in beside]
        for k in range(len(beside) - 1):
            a, b = across[k], across[k + 1]
            if a * b <= 0 and a != b:
                way = ahead[k] + (ahead[k + 1] - ahead[k]) * a / (a - b)
                if way >= 0:
                    yield way
