"""The options of each task: paths, end poses and durations per class of vehicles.

Vehicles of one class have the same speed, turn radius, altitude, climb rate and cameras, so they share
options. An option that the zones, the camera or the eligibility forbid is dropped, with the reason kept for
the user.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from cratous.core.geofence.mission_leg_arrays import first_bad
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.readings.tiered import swift
from cratous.core.routing.visibility import circle, name_of
from cratous.core.tasks.coverage import outline
from cratous.core.tasks.outside import area_outside, points_outside
from cratous.services.loading.ground import drives
from cratous.services.mission.sensor import sample_distance_m, sample_line, zoomed
from cratous.services.planning.area_ways import area_parts, area_ways
from cratous.services.planning.performance_classes import Flyer as Flyer
from cratous.services.planning.performance_classes import Way, camera_for
from cratous.services.planning.performance_classes import flight_ms as flight_ms
from cratous.services.planning.performance_classes import flyer_of as flyer_of
from cratous.services.planning.point_paths import (
    line_ways,
    loiter_ways,
    must_fly_ways,
    point_ways,
)
from cratous.services.planning.smoothing import ENOUGH
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import (
    AREAS,
    SEARCHES,
    Camera,
    Mission,
    Position,
    Task,
    TaskKind,
    Zone,
)
from cratous.spec.mission.plan import InPart, Pose

SEEN = {
    TaskKind.LINE_SEARCH: "the line",
    TaskKind.POINT_SEARCH: "the dwell",
    TaskKind.AREA_SEARCH: "the area",
    TaskKind.PATTERN_SEARCH: "the area",
}
CUT = (TaskKind.LINE_SEARCH, *AREAS)
"""Kinds of tasks of which a part is offered where zones forbid the whole."""
ALIKE = 0.01
"""Partial options are offered if their coverage is within this of the largest."""
HOLD_FACTORS = (2.0, 1.5, 1.2, 1.0)
"""Hold radii tried at a start pose, largest first, in turn radii."""


class HoldRoom(NamedTuple):
    """A side of a start pose with room to hold, and the largest radius there [m]."""

    clockwise: bool
    radius_m: float


@dataclass(frozen=True)
class Option:
    """One way to fly one task, for the vehicles named. Times in ms; coverage None: not required; part: the
    part of the task that it does, None: all of it.
    """

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
    view_azimuth_rad: float = 0.0
    part: InPart | None = None

    @property
    def lap_ms(self) -> int:
        """Duration of the shortest lap of a hold at the start pose [ms]."""
        return math.ceil(2000 * math.pi * self.flyer.radius_m / self.flyer.speed_m_s)

    @property
    def lap_max_ms(self) -> int:
        """Duration of the longest lap that there is room for [ms]; 0 if there is no room to hold."""
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


def expand(
    mission: Mission,
    tasks: Sequence[Task],
    zones: Sequence[Zone],
    in_part: bool = True,
) -> tuple[tuple[Option, ...], tuple[Dropped, ...]]:
    """All options of the tasks for the mission's vehicles, and those dropped.

    in_part: also options over a part of a task, if there is none over all of it.
    """
    classes: dict[Flyer, list[int]] = {}
    driving = tuple(vehicle.id for vehicle in mission.vehicles if drives(vehicle))
    for vehicle in mission.vehicles:
        if not drives(vehicle):
            classes.setdefault(flyer_of(vehicle), []).append(vehicle.id)
    options: list[Option] = []
    dropped: list[Dropped] = []
    for task in tasks:
        if driving and task.kind is not TaskKind.OTHER:
            dropped.append(Dropped(task.id, driving, "", "it drives, and the task is flown"))
        may: dict[Flyer, tuple[int, ...]] = {}
        for flyer, ids in classes.items():
            able = tuple(v for v in ids if not task.eligible or v in task.eligible)
            unable = tuple(v for v in ids if v not in able)
            if unable:
                dropped.append(Dropped(task.id, unable, "", "the task does not name it eligible"))
            if able and task.kind is TaskKind.OTHER:
                dropped.append(Dropped(task.id, able, "", "its own service says how it is flown"))
            elif able:
                may[flyer] = able
        made = _of_all(task, may, zones, mission.frame.terrain_m)
        offered = [one for one in made if isinstance(one, Option)]
        if in_part and not offered:
            offered = parts_of(task, may, zones, mission.frame.terrain_m)
        options += [replace(one, option_id=k) for k, one in enumerate(offered, 1)]
        dropped += [one for one in made if isinstance(one, Dropped)]
    return tuple(options), tuple(dropped)


def _of_all(
    task: Task, may: Mapping[Flyer, tuple[int, ...]], zones: Sequence[Zone], terrain_m: float
) -> list[Option | Dropped]:
    """The options of a task for each class; computed once for those that differ in the ids of their cameras."""
    known: dict[Flyer, list[Option | Dropped]] = {}
    made: list[Option | Dropped] = []
    for flyer, able in may.items():
        alike = flyer._replace(
            cameras=tuple(replace(one, payload_id=0, camera_id=0) for one in flyer.cameras)
        )
        if alike not in known:
            known[alike] = [*_options(task, flyer, able, zones, terrain_m)]
            made += known[alike]
            continue
        for one in known[alike]:
            if isinstance(one, Option):
                made.append(replace(one, vehicles=able, flyer=flyer))
            else:
                made.append(one._replace(vehicles=able))
    return made


def _options(
    task: Task, flyer: Flyer, able: tuple[int, ...], zones: Sequence[Zone], terrain_m: float
) -> Iterator[Option | Dropped]:
    camera = camera_for(task, flyer.cameras)
    if camera is not None:
        camera = zoomed(camera, task, flyer.alt_m - terrain_m)
    reason = unfit(task, flyer, camera, terrain_m)
    if reason:
        yield Dropped(task.id, able, "", reason)
        return
    for way in _ways(task, flyer, camera, zones, terrain_m):
        if way.reason:
            yield Dropped(task.id, able, way.label, way.reason)
            continue
        if way.coverage is not None and way.coverage < ENOUGH:
            yield Dropped(
                task.id,
                able,
                way.label,
                f"the camera covers {100 * way.coverage:.1f} % of {SEEN[task.kind]}",
            )
            continue
        bad = first_bad_leg(way.points, zones)
        if bad is not None:
            yield Dropped(task.id, able, way.label, f"its path breaks {name_of(bad[1])}")
            continue
        yield Option(
            task.id, 0, able, flyer, way.start, way.end, way.points, way.duration_ms,
            hold_rooms(way.start, flyer.radius_m, zones), way.label, way.coverage,
            way.elevation_rad, way.azimuth_rad,
        )  # fmt: skip


def parts_of(
    task: Task, may: Mapping[Flyer, tuple[int, ...]], zones: Sequence[Zone], terrain_m: float
) -> list[Option]:
    """Paths over what zones leave of a line or an area; those that cover less than the best by more than
    ALIKE are omitted.

    may: eligible vehicles, by class.
    """
    found = []
    for flyer, able in may.items() if task.kind in CUT and zones else ():
        camera = camera_for(task, flyer.cameras)
        if camera is not None:
            camera = zoomed(camera, task, flyer.alt_m - terrain_m)
        if unfit(task, flyer, camera, terrain_m):
            continue
        maps = roadmaps(zones, flyer.radius_m)
        ways = (
            line_ways(task, flyer, camera, terrain_m, maps)
            if task.kind is TaskKind.LINE_SEARCH or camera is None
            else area_parts(task, flyer, camera, maps, terrain_m)
        )
        for way in ways:
            # a path that no zone cuts was rejected for another reason
            if not way.zones or not way.coverage or first_bad_leg(way.points, zones) is not None:
                continue
            found.append(
                Option(
                    task.id, 0, able, flyer, way.start, way.end, way.points, way.duration_ms,
                    hold_rooms(way.start, flyer.radius_m, zones), way.label, way.coverage,
                    way.elevation_rad, way.azimuth_rad, _part(task, way, flyer, zones),
                )
            )  # fmt: skip
    most = max((option.coverage or 0.0 for option in found), default=0.0)
    return [option for option in found if (option.coverage or 0.0) >= most - ALIKE]


def _part(task: Task, way: Way, flyer: Flyer, zones: Sequence[Zone]) -> InPart | None:
    """The part of a task that a path does; None if its coverage suffices for the whole."""
    assert way.coverage is not None
    if camera_for(task, flyer.cameras) is not None and way.coverage >= ENOUGH:
        return None
    cutting = [zone for zone in zones if zone.id in {z.id for z in way.zones}]
    if task.kind in AREAS:
        outside = area_outside(outline(task), flyer.alt_m, cutting)
    else:
        points = [(float(n), float(e)) for n, e in sample_line(task.points)]
        outside = points_outside(points, flyer.alt_m, cutting)
    ids = tuple(zone.id for zone in cutting)
    names = ", ".join(name_of(zone) for zone in cutting)
    return InPart(task.id, way.coverage, outside, ids, names)


def unfit(task: Task, flyer: Flyer, camera: Camera | None, terrain_m: float) -> str:
    """Why a class of vehicles cannot do a search at all; "" if it can."""
    if task.kind not in SEARCHES:
        return ""
    needs = task.views or task.gsd_m or task.kind in AREAS or task.wavelength != "AllAny"
    if camera is None and (task.view is not None or needs):
        return f"it has no camera for wavelength {task.wavelength}"
    if camera is not None and flyer.alt_m <= terrain_m:
        return f"it flies at {flyer.alt_m:g} m, not above the terrain at {terrain_m:g} m"
    if any(view is not None and view.elevation_rad >= 0 for view in (task.view, *task.views)):
        return "the wanted view does not look down"
    if camera is not None and task.gsd_m > 0:
        if camera.pixels == 0:
            return "its camera names no resolution, so no ground sample distance is known"
        gsd_m = sample_distance_m(camera, task.view, flyer.alt_m - terrain_m)
        if gsd_m > task.gsd_m:
            return (
                f"its camera gives {gsd_m:.3g} m a pixel from {flyer.alt_m:g} m, "
                f"and {task.gsd_m:g} m are asked for"
            )
    return ""


def _ways(
    task: Task, flyer: Flyer, camera: Camera | None, zones: Sequence[Zone], terrain_m: float
) -> Iterator[Way]:
    if task.kind is TaskKind.LINE_SEARCH:
        return line_ways(task, flyer, camera, terrain_m)
    if task.kind is TaskKind.POINT_SEARCH:
        return point_ways(task, flyer, camera, terrain_m)
    if task.kind is TaskKind.MUST_FLY:
        return must_fly_ways(task, flyer)
    if task.kind is TaskKind.LOITER:
        return loiter_ways(task, flyer)
    assert camera is not None
    return area_ways(task, flyer, camera, zones, terrain_m)


def hold_rooms(pose: Pose, radius_m: float, zones: Sequence[Zone]) -> tuple[HoldRoom, ...]:
    """The sides of a pose on which a hold circle keeps the zones, and its largest radius.

    The circle flown in the end is smaller and is checked again (`stages.hold_of`).
    """
    if not zones:  # no circles to compute, and no machine code to load
        return tuple(HoldRoom(clockwise, HOLD_FACTORS[0] * radius_m) for clockwise in (True, False))
    rooms = []
    swift(first_bad, 10 * len(zones))  # announces the work: a circle has some fifty legs
    for clockwise in (True, False):
        for factor in HOLD_FACTORS:
            if first_bad_leg(circle(pose, factor * radius_m, clockwise), zones) is None:
                rooms.append(HoldRoom(clockwise, factor * radius_m))
                break
    return tuple(rooms)
