"""Checks of a mission beyond its schema: references that exist, valid shapes, permitted starts.

Each check reports findings in the user's terms; `where(item)` gives the file (and line) of an item such as
`zones[0].vertices`. Kernels decide on geometry with exact rationals, so a zone that merely touches itself is found
too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import wraps
from math import hypot, inf, isfinite
from typing import NamedTuple

from cratous.core.geofence.planar import edges_of, keep_in_leg_ok, keep_out_leg_ok, locate
from cratous.core.kernel import Vec2
from cratous.core.schedule.rows import runs_forward
from cratous.services.loading.polygons import polygon_problem
from cratous.services.mission.ground import floor_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Pattern, Position, TaskKind, Zone, ZoneKind, changes

Where = Callable[[str], str]
MAX_REACH_M = 100_000.0
ONE_POINT = (
    TaskKind.POINT_SEARCH,
    TaskKind.MUST_FLY,
    TaskKind.LOITER,
    TaskKind.PATTERN_SEARCH,
)


class Finding(NamedTuple):
    """A fault of an item; at: the item that appears in the file, if different."""

    item: str
    what: str
    expected: str
    got: str
    at: str = ""


def as_errors(
    check: Callable[[Mission], Iterator[Finding]],
) -> Callable[[Mission, Where], Iterator[BadInput]]:
    """The check with its findings as errors that include their position."""

    @wraps(check)
    def problems(mission: Mission, where: Where) -> Iterator[BadInput]:
        for item, what, expected, got, at in check(mission):
            yield BadInput(what, where=where(at or item), item=item, expected=expected, got=got)

    return problems


def mission_problems(mission: Mission, where: Where) -> list[BadInput]:
    """All faults of the mission that can be found before its zones are padded."""
    found: list[BadInput] = []
    for check in (_ids, _vehicles, _powers, _tasks, _zones, _places, _numbers, _instances):
        found.extend(as_errors(check)(mission, where))
    return found or list(relation_problems(mission, where))


def _duplicates(items: list[tuple[str, int]]) -> Iterator[Finding]:
    counts = Counter(number for _, number in items)
    seen: set[int] = set()
    for item, number in items:
        if counts[number] > 1 and number in seen:
            yield Finding(item, "an id is used twice", "ids that differ", str(number))
        seen.add(number)


def _ids(mission: Mission) -> Iterator[Finding]:
    aircraft = [(f"vehicles[{k}].id", v.id) for k, v in enumerate(mission.vehicles)]
    aircraft += [(f"traffic[{k}].id", t.id) for k, t in enumerate(mission.traffic)]
    yield from _duplicates(aircraft)
    yield from _duplicates([(f"tasks[{k}].id", t.id) for k, t in enumerate(mission.tasks)])
    yield from _duplicates([(f"zones[{k}].id", z.id) for k, z in enumerate(mission.zones)])


def _vehicles(mission: Mission) -> Iterator[Finding]:
    for k, vehicle in enumerate(mission.vehicles):
        low, high = vehicle.min_speed_m_s, vehicle.max_speed_m_s
        item = f"vehicles[{k}].speed_m_s"
        if low <= vehicle.speed_m_s <= high:
            continue
        # a missing speed defaults to the cruise speed: report only what was written
        if low > high and vehicle.speed_m_s not in (low, high):
            item = f"vehicles[{k}].max_speed_m_s"
            what = f"vehicle {vehicle.id} has a max_speed_m_s below its min_speed_m_s"
            expected, got = f"at least {low:g} m/s", high
        else:
            what, got = f"vehicle {vehicle.id} cannot fly at its cruise speed", vehicle.speed_m_s
            expected = f"{low:g} to {high:g} m/s"
            if low > high:
                most = vehicle.speed_m_s == low
                expected = f"at most {high:g} m/s" if most else f"at least {low:g} m/s"
        yield Finding(item, what, expected, f"{got:g} m/s")


def _powers(mission: Mission) -> Iterator[Finding]:
    for k, vehicle in enumerate(mission.vehicles):
        if mission.cost == "ENERGY" and vehicle.power_w is None:
            what = f"the cost ENERGY needs what vehicle {vehicle.id} draws in flight"
            item = f"vehicles[{k}].power_w"
            yield Finding(item, what, "a number of watts", "nothing", at=f"vehicles[{k}]")


def _tasks(mission: Mission) -> Iterator[Finding]:
    ids = [vehicle.id for vehicle in mission.vehicles]
    for k, task in enumerate(mission.tasks):
        item = f"tasks[{k}].eligible"
        for unknown in (number for number in task.eligible if number not in ids):
            yield Finding(
                item,
                f"task {task.id} names an eligible vehicle that does not exist",
                "one of " + ", ".join(map(str, ids)),
                str(unknown),
            )
        item = f"tasks[{k}].points"
        if task.kind in ONE_POINT and len(task.points) != 1:
            yield Finding(
                item, f"a {task.kind} task has one point", "1 point", f"{len(task.points)}"
            )
        if task.kind == TaskKind.LINE_SEARCH and len(set(task.points)) < 2:
            yield Finding(
                item,
                "a line_search task needs a line",
                "2 or more different points",
                f"{len(set(task.points))}",
            )
        if task.kind == TaskKind.AREA_SEARCH:
            problem = polygon_problem([point[:2] for point in task.points])
            if problem:
                yield Finding(
                    item,
                    f"the area of task {task.id} is not a valid polygon: {problem}",
                    "a simple polygon, edges meeting only at shared corners",
                    problem,
                )
        if task.kind == TaskKind.PATTERN_SEARCH and task.pattern is None:
            item = f"tasks[{k}].pattern"
            yield Finding(
                item,
                "a pattern_search task needs a pattern",
                "one of " + ", ".join(Pattern),
                "none",
            )
        if task.kind == TaskKind.PATTERN_SEARCH and not task.extent_m > 0:
            item = f"tasks[{k}].extent_m"
            yield Finding(
                item,
                "a pattern_search task needs an extent",
                "more than 0 m",
                f"{task.extent_m:g} m",
            )
        if task.kind == TaskKind.LOITER and task.duration_ms <= 0:
            item = f"tasks[{k}].duration_s"
            yield Finding(
                item,
                "a loiter task needs a duration",
                "more than 0 s",
                f"{task.duration_ms / 1000:g} s",
            )


def _zones(mission: Mission) -> Iterator[Finding]:
    for k, zone in enumerate(mission.zones):
        item = f"zones[{k}].vertices"
        problem = polygon_problem(zone.vertices)
        if problem:
            yield Finding(
                item,
                f"zone {zone.id} is not a valid polygon: {problem}",
                "a simple polygon, edges meeting only at shared corners",
                problem,
            )
        if zone.floor_m >= zone.ceiling_m:
            item = f"zones[{k}].ceiling_m"
            yield Finding(
                item,
                f"zone {zone.id} has no height",
                f"a ceiling above the floor of {zone.floor_m:g} m",
                f"{zone.ceiling_m:g} m",
            )


def _points(mission: Mission) -> Iterator[tuple[str, tuple[float, ...]]]:
    for k, vehicle in enumerate(mission.vehicles):
        yield f"vehicles[{k}].position", vehicle.position
    for k, task in enumerate(mission.tasks):
        for j, point in enumerate(task.points):
            yield f"tasks[{k}].points[{j}]", point
        if task.start_point is not None:
            yield f"tasks[{k}].start", task.start_point
        if task.loiter is not None:
            yield f"tasks[{k}].loiter.centre", task.loiter.centre
    for k, zone in enumerate(mission.zones):
        for j, vertex in enumerate(zone.vertices):
            yield f"zones[{k}].vertices[{j}]", vertex
    for k, traffic in enumerate(mission.traffic):
        yield f"traffic[{k}].position", traffic.position
    for k, change in enumerate(mission.changes):
        if isinstance(change, changes.HoldCommand) and change.place is not None:
            yield f"changes[{k}].vehicle_holds.place", change.place


def _places(mission: Mission) -> Iterator[Finding]:
    frame = mission.frame
    for item, point in _points(mission):
        north, east = point[0], point[1]
        if not (isfinite(north) and isfinite(east)):
            continue
        distance = hypot(north, east)
        if distance > MAX_REACH_M:
            yield Finding(
                item,
                "too far from the frame's origin",
                f"at most {MAX_REACH_M / 1000:g} km",
                f"{distance / 1000:.1f} km",
            )
        near = max(abs(frame.latitude_deg), abs(frame.longitude_deg)) > 3
        if near and abs(north - frame.latitude_deg) < 1 and abs(east - frame.longitude_deg) < 1:
            yield Finding(
                item,
                "degrees where metres are meant",
                "north_m and east_m from the frame's origin, or latitude_deg and longitude_deg",
                f"{north:g}, {east:g}, which is the frame's own latitude and longitude",
            )


def _numbers(mission: Mission) -> Iterator[Finding]:
    for item, point in _points(mission):
        if not all(isfinite(value) for value in point):
            yield Finding(
                item, "not a finite number", "finite numbers", ", ".join(map(repr, point))
            )
    volume = mission.daa.well_clear
    for name in ("dthr_m", "zthr_m", "tthr_s", "tcoa_s"):
        value = getattr(volume, name)
        if not (isfinite(value) and value >= 0):
            item = f"daa.well_clear.{name}"
            yield Finding(item, "a threshold is negative or not finite", "0 or more", f"{value:g}")


def _instances(mission: Mission) -> Iterator[Finding]:
    known = [vehicle.id for vehicle in mission.vehicles]
    for number in mission.instances:
        if number not in known:
            yield Finding(
                "bridge.instances",
                "an ICAROUS instance for a vehicle that does not exist",
                ", ".join(map(str, known)),
                str(number),
            )


def too_many_instances(wanted: int, vehicles: int, where: str, item: str) -> BadInput:
    """The refusal of a configuration with more ICAROUS instances than vehicles to guard."""
    return BadInput(
        "more ICAROUS instances than vehicles",
        where=where,
        item=item,
        expected=f"at most {vehicles}",
        got=str(wanted),
    )


def relation_problems(mission: Mission, where: Where) -> Iterator[BadInput]:
    """Faults of the process algebra, with a caret below the position."""
    if not mission.relations.strip():
        return
    from cratous.spec.algebra import atoms, parse

    place = where("relations")
    try:
        term = parse(mission.relations, frozenset(task.id for task in mission.tasks), where=place)
    except BadInput as problem:
        problem.item = problem.item or "relations"
        yield problem
        return
    named = {atom.task for atom in atoms(term)}
    for task in mission.tasks:
        if task.id not in named:
            yield BadInput(
                f"task {task.id} is in the mission but not in its relations",
                where=place,
                item="relations",
                expected=f"p{task.id} somewhere in the text",
                got=mission.relations.strip(),
            )


@as_errors
def change_problems(mission: Mission) -> Iterator[Finding]:
    """In-flight changes of unknown vehicles or tasks, or at too low altitudes, and missions that begin empty."""
    vehicles, tasks = {v.id for v in mission.vehicles}, {t.id for t in mission.tasks}
    floor_m = floor_of(mission)
    for k, change in enumerate(mission.changes):
        known = vehicles if change.vehicle else tasks
        number = change.vehicle or change.task
        if number and number not in known:
            yield Finding(
                f"changes[{k}].{change.kind}",
                f"{'vehicle' if change.vehicle else 'task'} {number} does not exist",
                "one of " + ", ".join(map(str, sorted(known))),
                str(number),
            )
        alt_m = change.alt_m if isinstance(change, changes.HoldCommand) else None
        if alt_m is not None and not keep_in_leg_ok(1, False, alt_m, alt_m, floor_m, inf):
            yield Finding(
                f"changes[{k}].vehicle_holds.alt_m",
                "no manoeuvre goes so low",
                f"above {floor_m:g} m MSL",
                f"{alt_m:g} m MSL",
            )
    later = [c for c in mission.changes if c.kind in (changes.TASK_ADDED, changes.VEHICLE_JOINS)]
    for all_of, name in ((vehicles, "vehicle"), (tasks, "task")):
        if all_of and all_of <= {getattr(c, name) for c in later}:
            yield Finding(
                "changes",
                f"the mission begins without a {name}",
                f"a {name} that takes part from the start",
                "all of them come later",
            )


@as_errors
def zone_end_problems(mission: Mission) -> Iterator[Finding]:
    """In-flight ends of zones that do not exist, have ended before, or apply to no leg until then."""
    step_ms = mission.simulation.step_ms
    known = {zone.id: 0 for zone in mission.zones}
    known |= {c.zone.id: c.at_ms for c in mission.changes if c.zone is not None}
    ended = dict[int, int]()
    for k, change in enumerate(mission.changes):
        if not isinstance(change, changes.ZoneEnd):
            continue
        number, item = change.zone_id, f"changes[{k}].zone_ends"
        at_s = f"{change.at_ms / 1000:g} s"
        if number not in known:
            names = ", ".join(map(str, sorted(known))) or "no zone, for there is none"
            what, expected, got = f"zone {number} does not exist", f"one of {names}", str(number)
        elif number in ended:
            what, expected = f"zone {number} ends twice", "each zone at most once"
            got = f"at {ended[number] / 1000:g} s and at {at_s}"
        # what becomes known between two steps is known at the second
        elif runs_forward(-(-change.at_ms // step_ms), -(-known[number] // step_ms)):
            what = f"zone {number} ends before a leg is flown under it"
            from_s = f"{known[number] / 1000:g} s"
            expected = f"an end after {from_s}, when it is known, by a step of {step_ms} ms or more"
            item, got = f"changes[{k}].at_s", at_s
        else:
            ended[number] = change.at_ms
            continue
        yield Finding(item, what, expected, got)


@as_errors
def start_problems(mission: Mission) -> Iterator[Finding]:
    """Vehicles that start inside a keep-out zone or outside a keep-in zone (padding included)."""
    for k, vehicle in enumerate(mission.vehicles):
        for zone in mission.zones:
            if not start_is_allowed(vehicle.position, zone):
                out = zone.kind == ZoneKind.KEEP_OUT
                item = f"vehicles[{k}].position"
                yield Finding(
                    item,
                    f"vehicle {vehicle.id} starts "
                    + (
                        f"inside keep-out zone {zone.id}"
                        if out
                        else f"outside keep-in zone {zone.id}"
                    ),
                    f"a start {'outside' if out else 'strictly inside'} it"
                    + f" (between {zone.floor_m:g} and {zone.ceiling_m:g} m MSL)",
                    _place(vehicle.position),
                )


def start_is_allowed(position: Position, zone: Zone) -> bool:
    """Whether a point respects a zone; exact, by the kernels."""
    point = Vec2(Fraction(position.north_m), Fraction(position.east_m))  # type: ignore[arg-type]
    corners = [(Fraction(north), Fraction(east)) for north, east in zone.vertices]
    inside = locate(edges_of(corners), point)  # type: ignore[arg-type]
    decide = keep_out_leg_ok if zone.kind == ZoneKind.KEEP_OUT else keep_in_leg_ok
    return decide(inside, inside == 0, position.alt_m, position.alt_m, zone.floor_m, zone.ceiling_m)


def _place(position: Position) -> str:
    return f"{position.north_m:g} m north, {position.east_m:g} m east, {position.alt_m:g} m MSL"
