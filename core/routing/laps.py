"""Closed paths of loiters, as turns and straights of one lap, and their flight over a given length.

Shapes as in CMASI: a racetrack's straights have `length_m`, a figure-eight has its turn centres `length_m` apart (2
radii at least); both are length_m + 2 radius_m long. Nothing here is trusted: legs are checked by the zone kernels,
and the monitor measures what was flown.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from cratous.core.routing.dubins import LEFT, RIGHT, STRAIGHT, pose_after
from cratous.spec.mission import Loiter, Position
from cratous.spec.mission.plan import Pose

Lap = tuple[Pose, tuple[tuple[int, float], ...]]
"""The start pose of a lap, and its segments: kind and length [m]."""
CHORD_ERROR_M = 0.5


def lap_of(loiter: Loiter, radius_m: float, clockwise: bool) -> Lap:
    """One lap, turns of radius_m; clockwise is the sense of the first turn."""
    side = RIGHT if clockwise else LEFT
    h, r = loiter.axis_rad, radius_m
    centre = Pose(*loiter.centre, h)
    turn = math.pi * r
    if loiter.shape == "racetrack" and loiter.length_m > 0:
        ahead = pose_after(centre, STRAIGHT, loiter.length_m / 2, r)
        begin = _beside(ahead, -side * r)
        half = ((side, turn), (STRAIGHT, loiter.length_m))
        return begin, half + half
    if loiter.shape == "figure_eight":
        apart = max(loiter.length_m, 2 * r)
        # inner tangents of the two circles cross in the middle; a is their angle to the axis
        a = math.asin(2 * r / apart)
        run, bend = math.sqrt(max(0.0, apart * apart - 4 * r * r)), math.pi + 2 * a
        begin = Pose(*centre[:3], h - side * a)
        half_run = (STRAIGHT, run / 2)
        return begin, (half_run, (side, bend * r), (STRAIGHT, run), (-side, bend * r), half_run)
    return _beside(centre, -side * r), ((side, 2 * turn),)


def _beside(pose: Pose, right_m: float) -> Pose:
    """The pose displaced to its right."""
    n, e, alt, h = pose
    return Pose(n - right_m * math.sin(h), e + right_m * math.cos(h), alt, h)


def lap_length_m(lap: Lap) -> float:
    """Length of a lap [m]."""
    return sum(length for _, length in lap[1])


def _poses(lap: Lap, radius_m: float, from_m: float) -> Iterator[Pose]:
    """Poses along repeated laps from a position on the lap, close enough to be joined by chords."""
    step = 2 * math.acos(max(0.0, 1 - CHORD_ERROR_M / radius_m)) * radius_m
    skip, first = from_m % lap_length_m(lap), True
    while True:
        pose = lap[0]
        for kind, length in lap[1]:
            before, pose = pose, pose_after(pose, kind, length, radius_m)
            if first and skip >= length:
                skip -= length
                continue
            here, rest = pose_after(before, kind, skip, radius_m), length - skip
            if first:
                yield here
            count = 1 if kind == STRAIGHT else max(1, math.ceil(rest / step))
            for k in range(1, count + 1):
                yield pose_after(here, kind, rest * k / count, radius_m)
            first, skip = False, 0.0


def _round(
    lap: Lap, radius_m: float, from_m: float, length_m: float
) -> tuple[Pose, Pose, tuple[Position, ...]]:
    """The same on a circle: equal chords that add up to the length, with all ends on the circle."""
    kind = lap[1][0][0]
    step = 2 * math.acos(max(0.0, 1 - CHORD_ERROR_M / radius_m)) * radius_m
    count = max(1, math.ceil(length_m / step))
    arc = 2 * radius_m * math.asin(min(1.0, length_m / count / (2 * radius_m)))
    start = pose_after(lap[0], kind, from_m, radius_m)
    poses = [pose_after(start, kind, arc * k, radius_m) for k in range(count + 1)]
    return start, poses[-1], tuple(Position(*pose[:3]) for pose in poses)


def flown(
    lap: Lap, radius_m: float, from_m: float, length_m: float
) -> tuple[Pose, Pose, tuple[Position, ...]]:
    """Start pose, end pose and a polyline of exactly length_m, along the lap from from_m on."""
    if len(lap[1]) == 1:
        return _round(lap, radius_m, from_m, length_m)
    poses = _poses(lap, radius_m, from_m)
    here = start = next(poses)
    points, left = [Position(*here[:3])], length_m
    while left > 1e-9:
        after = next(poses)
        leg = math.hypot(after.north_m - here.north_m, after.east_m - here.east_m)
        if leg <= 1e-9:
            continue
        if leg > left:
            share = left / leg
            bearing = math.atan2(after.east_m - here.east_m, after.north_m - here.north_m)
            after = Pose(
                here.north_m + share * (after.north_m - here.north_m),
                here.east_m + share * (after.east_m - here.east_m),
                here.alt_m,
                bearing,
            )
            leg = left
        points.append(Position(*after[:3]))
        left -= leg
        here = after
    return start, here, tuple(points)
