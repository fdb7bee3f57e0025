"""Paths along a line, past or around a point, through a point, and of a loiter."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from cratous.core.routing.dubins import LEFT, RIGHT, polyline_length_m
from cratous.core.routing.laps import flown, lap_length_m, lap_of
from cratous.core.routing.visibility import Roadmap
from cratous.services.mission.sensor import coverage, elevation_rad, share_seen, view_distance_m
from cratous.services.planning.cut_paths import cut
from cratous.services.planning.performance_classes import (
    HEADING_STEP_DEG,
    MOMENT_MS,
    Flyer,
    Way,
    flight_ms,
    no_way,
    straight,
)
from cratous.services.planning.smoothing import ENOUGH, line_path
from cratous.spec.mission import Camera, Loiter, Position, Task, View
from cratous.spec.mission.plan import Pose

LOITER_ENTRIES = 8
LAPS_MAX = 10_000
"""Most laps of a loiter: each is planned point by point, which costs memory."""
TILT = 0.95
"""Oblique views are tilted by this share of the gimbal's range."""
STRAIGHT_DOWN_RAD = math.radians(-85)
"""A camera with this lowest elevation or below counts as looking straight down."""
VIEWS_MOST = 16
"""Most directions of view offered, to limit the number of options."""
STANDOFF_MARGIN_M = 25.0
"""Distance added to the standoff in planning, as a margin for tracking errors [m]."""
SIDES = {"any": (RIGHT, LEFT), "clockwise": (RIGHT,), "counter_clockwise": (LEFT,)}


def views_of(task: Task) -> tuple[View | None, ...]:
    """All acceptable views; (None,) means any."""
    return (task.view, *task.views)


def line_ways(
    task: Task,
    flyer: Flyer,
    camera: Camera | None,
    terrain_m: float,
    roadmaps: Sequence[Roadmap] | None = None,
) -> Iterator[Way]:
    """Both directions of a line for each wanted view, offset so that the view looks at it.

    roadmaps: if given, paths that cover the line are cut where zones forbid them, and the rest is joined.
    """
    views = tilted(task, camera) or views_of(task)
    for number, view in enumerate(views[:VIEWS_MOST], 1):
        for label, points in (("forward", task.points), ("backward", task.points[::-1])):
            line = replace(task, points=points, view=view)
            made = line_path(line, camera, flyer.radius_m, flyer.alt_m, terrain_m)
            seen = None if camera is None else coverage(made.points, line, camera, terrain_m)
            duration = flight_ms(made.length_m, flyer.speed_m_s)
            named = label if len(views) == 1 else f"{label}, view {number}"
            way = Way(named, made.start, made.end, made.points, duration, seen)
            if roadmaps is not None:
                way = _cut(way, line, flyer, camera, terrain_m, roadmaps)
            yield _looking(way, camera, view)
    yield from _left_out(len(views))


def _cut(
    way: Way,
    line: Task,
    flyer: Flyer,
    camera: Camera | None,
    terrain_m: float,
    roadmaps: Sequence[Roadmap],
) -> Way:
    """A path along a line without the parts that zones forbid; its coverage is that of the whole line."""
    if way.coverage is not None and way.coverage < ENOUGH:
        return way
    left = cut([way.points], flyer.radius_m, roadmaps, in_order=True)
    if not left.points:
        return no_way(way.label, "no part of it outside of the zones has room to turn")
    length_m = polyline_length_m(left.points)
    seen = length_m / polyline_length_m(way.points)
    if camera is not None:
        seen = coverage(left.points, line, camera, terrain_m)
    duration = flight_ms(length_m, flyer.speed_m_s)
    label = f"{way.label}, in part"
    return Way(label, left.start, left.end, left.points, duration, seen, zones=left.zones)


def tilted(task: Task, camera: Camera | None) -> tuple[View, ...]:
    """Views to both sides, ahead and back, for a camera that cannot look straight down.

    Only if no view is required; such a camera needs one, since a look straight below would swing with every
    disturbance. A view ahead or back follows the line itself, so it loses nothing in bends narrower than the
    distance of a side view.
    """
    if camera is None or views_of(task) != (None,) or camera.min_elevation_rad <= STRAIGHT_DOWN_RAD:
        return ()
    tilt = TILT * camera.min_elevation_rad
    return tuple(View(quarter * math.pi / 2, tilt, False) for quarter in (1, -1, 0, 2))


def _left_out(count: int) -> Iterator[Way]:
    if count > VIEWS_MOST:
        label = f"views {VIEWS_MOST + 1} to {count}"
        yield no_way(label, f"only the first {VIEWS_MOST} directions of view are offered")


def _looking(way: Way, camera: Camera | None, view: View | None) -> Way:
    if camera is None:
        return way
    azimuth = view.azimuth_rad if view is not None else 0.0
    return way._replace(elevation_rad=elevation_rad(camera, view), azimuth_rad=azimuth)


def must_fly_ways(task: Task, flyer: Flyer) -> Iterator[Way]:
    """Straight passes through the point, from all directions."""
    point = _at_altitude(task.points[0], flyer)
    for degrees in range(0, 360, HEADING_STEP_DEG):
        pose = Pose(*point, math.radians(degrees))
        yield straight(f"heading {degrees} deg", pose, MOMENT_MS, flyer.speed_m_s)


def _at_altitude(point: Position, flyer: Flyer) -> Position:
    return point if point.alt_m > 0 else Position(point.north_m, point.east_m, flyer.alt_m)


def point_ways(task: Task, flyer: Flyer, camera: Camera | None, terrain_m: float) -> Iterator[Way]:
    """Passes from which a point is seen for the whole dwell time; circles if no pass is long enough."""
    target, dwell = task.points[0], max(task.duration_ms, MOMENT_MS)
    if task.loiter is not None:
        wide = replace(task.loiter, radius_m=max(task.loiter.radius_m, flyer.radius_m))
        for way in _rounds(_apart(wide, task), dwell, flyer):
            yield _checked(way, task, task.view, camera, terrain_m)
        return
    found, farthest = [], 0.0
    for view, look, heading, label in _aims(task):
        away = view_distance_m(view, flyer.alt_m - terrain_m)
        if task.standoff_m > 0 and away < task.standoff_m + STANDOFF_MARGIN_M:
            # the standoff overrides the tilt of a view: farther away, in the view's direction
            away = task.standoff_m + STANDOFF_MARGIN_M
            if view is not None:
                view = replace(view, elevation_rad=-math.atan2(flyer.alt_m - terrain_m, away))
                label += ", at the standoff"
        farthest = max(farthest, away)
        pose = Pose(
            target.north_m - away * math.cos(look),
            target.east_m - away * math.sin(look),
            flyer.alt_m,
            heading,
        )
        way = straight(label, pose, dwell, flyer.speed_m_s)
        found.append(_checked(way, task, view, camera, terrain_m))
    yield from found
    if all(way.reason or (way.coverage is not None and way.coverage < ENOUGH) for way in found):
        # too long for a straight pass: circle around the target instead
        centre = Position(target.north_m, target.east_m, flyer.alt_m)
        around = Loiter(centre, max(flyer.radius_m, farthest))
        for way in _rounds(around, dwell, flyer):
            yield _checked(way, task, task.view, camera, terrain_m)
    yield from _left_out(len(views_of(task)))


def _apart(loiter: Loiter, task: Task) -> Loiter:
    """A loiter around the point itself, at least the standoff distance plus margin away."""
    least = task.standoff_m + STANDOFF_MARGIN_M
    if task.standoff_m <= 0 or loiter.shape != "circular" or loiter.radius_m >= least:
        return loiter
    gap = math.dist(loiter.centre[:2], task.points[0][:2])
    return replace(loiter, radius_m=least + gap)


def _aims(task: Task) -> Iterator[tuple[View | None, float, float, str]]:
    """View, look direction, heading [rad] and name of each pass; a bounded number."""
    every = range(0, 360, HEADING_STEP_DEG)
    views = views_of(task)[:VIEWS_MOST]
    only = views[0]
    if len(views) == 1 and (only is None or only.azimuth_extent_rad == 0):
        for degrees in every:
            heading = math.radians(degrees)
            name = f"heading {degrees} deg"
            if only is not None:
                look = only.azimuth_rad + (0.0 if only.inertial else heading)
                yield only, look, heading, name
            elif task.standoff_m > 0:
                yield None, heading - math.pi / 2, heading, f"{name}, looking left"
                yield None, heading + math.pi / 2, heading, f"{name}, looking right"
            else:
                yield None, heading, heading, name
        return
    for view in views:
        assert view is not None
        half = round(math.degrees(view.azimuth_extent_rad) / 2) if view else 0
        offsets = sorted(
            {o for k in every for o in (k, -k) if o <= half and -o <= half and o < 180}
        )
        for offset in offsets[:: max(1, math.ceil(len(offsets) * len(views) / 18))]:
            azimuth = view.azimuth_rad + math.radians(offset)
            for turn in (0, 90, -90):
                degrees = round(math.degrees(azimuth)) + turn
                heading = math.radians(degrees if view.inertial else turn)
                look = azimuth if view.inertial else azimuth + heading
                name = f"look {round(math.degrees(azimuth)) % 360} deg, heading "
                yield view, look, heading, f"{name}{round(math.degrees(heading)) % 360} deg"


def _checked(
    way: Way, task: Task, view: View | None, camera: Camera | None, terrain_m: float
) -> Way:
    """The path with the share of the dwell during which the camera sees the point; rejected if it violates
    the standoff.
    """
    if way.reason:
        return way
    nearest_m = _nearest_m(way.points, task.points[0])
    if nearest_m < task.standoff_m:
        return way._replace(
            reason=f"it comes within {nearest_m:.0f} m of the point, "
            f"and the standoff is {task.standoff_m:g} m"
        )
    if camera is None:
        return way
    seen = share_seen(way.points, replace(task, view=view), camera, terrain_m)
    return _looking(way._replace(coverage=seen), camera, view)


def _nearest_m(points: tuple[Position, ...], target: Position) -> float:
    """Smallest horizontal distance of a polyline from a point [m]."""
    best = math.inf
    for p, q in pairwise(points):
        n, e = q.north_m - p.north_m, q.east_m - p.east_m
        t = (target.north_m - p.north_m) * n + (target.east_m - p.east_m) * e
        t = min(max(t / (n * n + e * e or 1.0), 0.0), 1.0)
        gap = (p.north_m + t * n - target.north_m, p.east_m + t * e - target.east_m)
        best = min(best, math.hypot(*gap))
    return best


def loiter_ways(task: Task, flyer: Flyer) -> Iterator[Way]:
    """Laps of exactly the task's duration, entered along the lap at several places."""
    loiter = task.loiter or Loiter(task.points[0], task.radius_m)
    yield from _rounds(loiter, task.duration_ms, flyer)


def _rounds(loiter: Loiter, duration_ms: int, flyer: Flyer) -> Iterator[Way]:
    loiter = replace(loiter, centre=_at_altitude(loiter.centre, flyer))
    radius = max(loiter.radius_m, flyer.radius_m)
    if 0 < loiter.radius_m < radius:
        yield no_way(
            loiter.shape,
            f"its turn radius of {radius:.0f} m is wider than the loiter's {loiter.radius_m:g} m",
        )
        return
    length = flyer.speed_m_s * duration_ms / 1000
    once = lap_length_m(lap_of(loiter, radius, True))
    if length > LAPS_MAX * once:
        yield no_way(
            loiter.shape,
            f"{duration_ms / 1000:g} s are {length / once:.3g} laps, and no more than {LAPS_MAX} are planned",
        )
        return
    for k in range(LOITER_ENTRIES):
        for side in SIDES[loiter.direction]:
            lap = lap_of(loiter, radius, side == RIGHT)
            at = lap_length_m(lap) * k / LOITER_ENTRIES
            start, end, points = flown(lap, radius, at, length)
            turn = "right" if side == RIGHT else "left"
            label = f"{loiter.shape}, {turn} turns, entry {k + 1} of {LOITER_ENTRIES}"
            yield Way(label, start, end, points, duration_ms)
