"""The ways to fly each task: paths, end poses and durations per class of vehicles.

Vehicles of one class have the same speed, turn radius, altitude, climb and cameras, so they share
options. An option that the zones, the camera or the eligibility forbid is dropped, with the
reason kept for the user.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from cratous.core.dubins import LEFT, RIGHT, pose_after, turn_radius_m
from cratous.core.legs import first_bad_leg
from cratous.core.visibility import circle, name_of, start_point
from cratous.services.planning.smoothing import ENOUGH, line_path
from cratous.services.sensor import coverage, share_seen, view_distance_m
from cratous.spec.mission import Camera, Mission, Position, Task, TaskKind, Vehicle, Zone
from cratous.spec.plan import Pose

BANK_RESERVE = 1.1
"""Planned turns are this much wider than the tightest ones, so that the autopilot can correct."""
HEADING_STEP_DEG = 20
LOITER_ENTRIES = 8
MOMENT_MS = 1_000
"""How long a pass over a point lasts if the task asks for no dwell [ms]."""
HOLD_FACTORS = (2.0, 1.5, 1.2, 1.0)
"""Largest hold circles that are tried at a start pose, in turn radii."""


class Flyer(NamedTuple):
    """A class of vehicles that fly alike."""

    speed_m_s: float
    radius_m: float
    alt_m: float
    max_climb_m_s: float
    cameras: tuple[Camera, ...]


class HoldRoom(NamedTuple):
    """On which side of a start pose there is room to hold, up to which radius."""

    clockwise: bool
    radius_m: float


@dataclass(frozen=True)
class Option:
    """One way to fly one task, for the vehicles named. Times in ms; coverage None: not asked."""

    task_id: int
    option_id: int
    vehicles: tuple[int, ...]
    flyer: Flyer
    start: Pose
    end: Pose
    path: tuple[Position, ...]
    duration_ms: int
    holds: tuple[HoldRoom, ...]
    label: str
    coverage: float | None = None
    view_elevation_rad: float | None = None

    @property
    def lap_ms(self) -> int:
        """The shortest lap of a hold at the start pose."""
        return math.ceil(2000 * math.pi * self.flyer.radius_m / self.flyer.speed_m_s)

    @property
    def lap_max_ms(self) -> int:
        """The longest lap that there is room for; 0 if there is no room to hold."""
        widest = max((room.radius_m for room in self.holds), default=0.0)
        return max(math.floor(2000 * math.pi * widest / self.flyer.speed_m_s), self.lap_ms) * bool(
            self.holds
        )


class Dropped(NamedTuple):
    """An option that was not offered, and why."""

    task_id: int
    vehicles: tuple[int, ...]
    label: str
    reason: str


class Way(NamedTuple):
    """A path of a task before it is checked."""

    label: str
    start: Pose
    end: Pose
    points: tuple[Position, ...]
    duration_ms: int
    coverage: float | None = None


def flyer_of(vehicle: Vehicle) -> Flyer:
    """The class of a vehicle; it cruises at the altitude of its start in the mission."""
    radius = BANK_RESERVE * turn_radius_m(vehicle.speed_m_s, vehicle.max_bank_rad)
    alt = vehicle.position.alt_m
    return Flyer(vehicle.speed_m_s, radius, alt, vehicle.max_climb_m_s, vehicle.cameras)


def flight_ms(length_m: float, speed_m_s: float) -> int:
    """Time to fly a length [ms], rounded up."""
    return math.ceil(1000 * length_m / speed_m_s - 1e-6)


def expand(
    mission: Mission,
    tasks: Sequence[Task],
    zones: Sequence[Zone],
) -> tuple[tuple[Option, ...], tuple[Dropped, ...]]:
    """All options of the tasks for the mission's vehicles, and those dropped."""
    classes: dict[Flyer, list[int]] = {}
    for vehicle in mission.vehicles:
        classes.setdefault(flyer_of(vehicle), []).append(vehicle.id)
    options: list[Option] = []
    dropped: list[Dropped] = []
    for task in tasks:
        number = 1
        for flyer, ids in classes.items():
            able = tuple(v for v in ids if not task.eligible or v in task.eligible)
            unable = tuple(v for v in ids if v not in able)
            if unable:
                dropped.append(Dropped(task.id, unable, "", "the task does not name it eligible"))
            if not able:
                continue
            for made in _options(task, flyer, able, zones, mission.frame.terrain_m):
                if isinstance(made, Option):
                    options.append(replace(made, option_id=number))
                    number += 1
                else:
                    dropped.append(made)
    return tuple(options), tuple(dropped)


def _options(
    task: Task, flyer: Flyer, able: tuple[int, ...], zones: Sequence[Zone], terrain_m: float
) -> Iterator[Option | Dropped]:
    camera = camera_for(task, flyer.cameras)
    reason = _unfit(task, flyer, camera, terrain_m)
    if reason:
        yield Dropped(task.id, able, "", reason)
        return
    for way in _ways(task, flyer, camera, terrain_m):
        if way.coverage is not None and way.coverage < ENOUGH:
            seen = "the line" if task.kind is TaskKind.LINE_SEARCH else "the dwell"
            yield Dropped(
                task.id, able, way.label, f"the camera covers {100 * way.coverage:.1f} % of {seen}"
            )
            continue
        bad = first_bad_leg(way.points, zones)
        if bad is not None:
            yield Dropped(task.id, able, way.label, f"its path breaks {name_of(bad[1])}")
            continue
        elevation = None
        if camera is not None and task.kind in (TaskKind.LINE_SEARCH, TaskKind.POINT_SEARCH):
            wanted = task.view.elevation_rad if task.view else -math.pi / 2
            elevation = max(camera.min_elevation_rad, min(camera.max_elevation_rad, wanted))
        yield Option(
            task.id, 0, able, flyer, way.start, way.end, way.points, way.duration_ms,
            hold_rooms(way.start, flyer.radius_m, zones), way.label, way.coverage, elevation,
        )  # fmt: skip


def camera_for(task: Task, cameras: Sequence[Camera]) -> Camera | None:
    """The widest camera that sees the wanted wavelength."""
    fit = [c for c in cameras if "AllAny" in (task.wavelength, c.wavelength)]
    fit += [c for c in cameras if c.wavelength == task.wavelength and c not in fit]
    return max(fit, key=lambda c: c.hfov_rad, default=None)


def _unfit(task: Task, flyer: Flyer, camera: Camera | None, terrain_m: float) -> str:
    """Why a class of vehicles cannot do a search at all, or nothing."""
    if task.kind not in (TaskKind.LINE_SEARCH, TaskKind.POINT_SEARCH):
        return ""
    if camera is None and (task.view is not None or task.wavelength != "AllAny"):
        return f"it has no camera for wavelength {task.wavelength}"
    if camera is not None and flyer.alt_m <= terrain_m:
        return f"it flies at {flyer.alt_m:g} m, not above the terrain at {terrain_m:g} m"
    if task.view is not None and task.view.elevation_rad >= 0:
        return "the wanted view does not look down"
    return ""


def _ways(task: Task, flyer: Flyer, camera: Camera | None, terrain_m: float) -> Iterator[Way]:
    if task.kind is TaskKind.LINE_SEARCH:
        yield from _line_ways(task, flyer, camera, terrain_m)
    elif task.kind is TaskKind.POINT_SEARCH:
        yield from _point_ways(task, flyer, camera, terrain_m)
    elif task.kind is TaskKind.MUST_FLY:
        point = _at_altitude(task.points[0], flyer)
        for degrees in range(0, 360, HEADING_STEP_DEG):
            pose = Pose(*point, math.radians(degrees))
            yield _straight(f"heading {degrees} deg", pose, MOMENT_MS, flyer.speed_m_s)
    else:
        centre = _at_altitude(task.points[0], flyer)
        radius = max(flyer.radius_m, task.radius_m)
        yield from _circling(centre, radius, task.duration_ms, flyer)


def _at_altitude(point: Position, flyer: Flyer) -> Position:
    return point if point.alt_m > 0 else Position(point.north_m, point.east_m, flyer.alt_m)


def _line_ways(task: Task, flyer: Flyer, camera: Camera | None, terrain_m: float) -> Iterator[Way]:
    for label, points in (("forward", task.points), ("backward", task.points[::-1])):
        line = replace(task, points=points)
        made = line_path(line, camera, flyer.radius_m, flyer.alt_m, terrain_m)
        seen = None if camera is None else coverage(made.points, line, camera, terrain_m)
        duration = flight_ms(made.length_m, flyer.speed_m_s)
        yield Way(label, made.start, made.end, made.points, duration, seen)


def _point_ways(task: Task, flyer: Flyer, camera: Camera | None, terrain_m: float) -> Iterator[Way]:
    target = task.points[0]
    away = view_distance_m(task.view, flyer.alt_m - terrain_m)
    found = []
    for degrees in range(0, 360, HEADING_STEP_DEG):
        heading = math.radians(degrees)
        look = heading
        if task.view is not None:
            look = task.view.azimuth_rad + (0.0 if task.view.inertial else heading)
        pose = Pose(
            target.north_m - away * math.cos(look),
            target.east_m - away * math.sin(look),
            flyer.alt_m,
            heading,
        )
        dwell = max(task.duration_ms, MOMENT_MS)
        way = _straight(f"heading {degrees} deg", pose, dwell, flyer.speed_m_s)
        found.append(_with_share(way, task, camera, terrain_m))
    if all(way.coverage is not None and way.coverage < ENOUGH for way in found):
        # too long for a straight pass: circle around the target instead
        centre = Position(target.north_m, target.east_m, flyer.alt_m)
        rounds = _circling(
            centre, max(flyer.radius_m, away), max(task.duration_ms, MOMENT_MS), flyer
        )
        found += [_with_share(way, task, camera, terrain_m) for way in rounds]
    yield from found


def _with_share(way: Way, task: Task, camera: Camera | None, terrain_m: float) -> Way:
    if camera is None:
        return way
    return way._replace(coverage=share_seen(way.points, task, camera, terrain_m))


def _straight(label: str, middle: Pose, duration_ms: int, speed_m_s: float) -> Way:
    half = speed_m_s * duration_ms / 2000
    start, end = pose_after(middle, 0, -half, 1.0), pose_after(middle, 0, half, 1.0)
    points = (start_point(start), start_point(middle), start_point(end))
    return Way(label, start, end, points, duration_ms)


def _circling(centre: Position, radius_m: float, duration_ms: int, flyer: Flyer) -> Iterator[Way]:
    """Circles of exactly this duration, entered along the tangent at several places."""
    flown = flyer.speed_m_s * duration_ms / 1000
    step = 2 * math.acos(1 - 0.5 / radius_m) * radius_m
    count = max(1, math.ceil(flown / step))
    # chords that add up to the length flown, so that the polyline takes exactly the duration
    arc = 2 * radius_m * math.asin(min(1.0, flown / count / (2 * radius_m)))
    for k in range(LOITER_ENTRIES):
        angle = 2 * math.pi * k / LOITER_ENTRIES
        for kind in (RIGHT, LEFT):
            start = Pose(
                centre.north_m + radius_m * math.cos(angle),
                centre.east_m + radius_m * math.sin(angle),
                centre.alt_m,
                angle + kind * math.pi / 2,
            )
            poses = [pose_after(start, kind, arc * j, radius_m) for j in range(count + 1)]
            turn = "right" if kind == RIGHT else "left"
            label = f"{turn} turns from {math.degrees(angle):.0f} deg"
            yield Way(label, start, poses[-1], tuple(map(start_point, poses)), duration_ms)


def hold_rooms(pose: Pose, radius_m: float, zones: Sequence[Zone]) -> tuple[HoldRoom, ...]:
    """On which sides of a pose a hold circle obeys the zones, and how wide it may be.

    The circle that is flown in the end is narrower and is checked again (`stages.hold_of`).
    """
    rooms = []
    for clockwise in (True, False):
        for factor in HOLD_FACTORS:
            if first_bad_leg(circle(pose, factor * radius_m, clockwise), zones) is None:
                rooms.append(HoldRoom(clockwise, factor * radius_m))
                break
    return tuple(rooms)
