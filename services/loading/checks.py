"""What a schema cannot say of a mission: names that exist, shapes that are shapes, fair starts.

Each check gives its findings as `BadInput` in the user's terms; `where(item)` says in which file
(and line) an item like `zones[0].vertices` stands. Geometry is decided by the kernels on exact
rationals, so a zone that merely touches itself is found too.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from fractions import Fraction
from math import hypot, isfinite

from cratous.core.geofence.planar import edges_of, keep_in_leg_ok, keep_out_leg_ok, locate
from cratous.core.kernel import Vec2
from cratous.core.schedule.rows import runs_forward
from cratous.services.loading.polygons import polygon_problem
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


def mission_problems(mission: Mission, where: Where) -> list[BadInput]:
    """Everything wrong with the mission before its zones are padded."""
    found: list[BadInput] = []
    for check in (_ids, _vehicles, _powers, _tasks, _zones, _places, _numbers, _instances):
        found.extend(check(mission, where))
    return found or list(relation_problems(mission, where))


def _duplicates(items: list[tuple[str, int]], where: Where) -> Iterator[BadInput]:
    counts = Counter(number for _, number in items)
    seen: set[int] = set()
    for item, number in items:
        if counts[number] > 1 and number in seen:
            yield BadInput(
                "an id is used twice",
                where=where(item),
                item=item,
                expected="ids that differ",
                got=str(number),
            )
        seen.add(number)


def _ids(mission: Mission, where: Where) -> Iterator[BadInput]:
    aircraft = [(f"vehicles[{k}].id", v.id) for k, v in enumerate(mission.vehicles)]
    aircraft += [(f"traffic[{k}].id", t.id) for k, t in enumerate(mission.traffic)]
    yield from _duplicates(aircraft, where)
    yield from _duplicates([(f"tasks[{k}].id", t.id) for k, t in enumerate(mission.tasks)], where)
    yield from _duplicates([(f"zones[{k}].id", z.id) for k, z in enumerate(mission.zones)], where)


def _vehicles(mission: Mission, where: Where) -> Iterator[BadInput]:
    for k, vehicle in enumerate(mission.vehicles):
        low, high = vehicle.min_speed_m_s, vehicle.max_speed_m_s
        item = f"vehicles[{k}].speed_m_s"
        if low <= vehicle.speed_m_s <= high:
            continue
        # a speed that is not given is the cruise speed: only what was written is named
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
        yield BadInput(what, where=where(item), item=item, expected=expected, got=f"{got:g} m/s")


def _powers(mission: Mission, where: Where) -> Iterator[BadInput]:
    for k, vehicle in enumerate(mission.vehicles):
        if mission.cost == "ENERGY" and vehicle.power_w is None:
            yield BadInput(
                f"the cost ENERGY needs what vehicle {vehicle.id} draws in flight",
                where=where(f"vehicles[{k}]"),
                item=f"vehicles[{k}].power_w",
                expected="a number of watts",
                got="nothing",
            )


def _tasks(mission: Mission, where: Where) -> Iterator[BadInput]:
    ids = [vehicle.id for vehicle in mission.vehicles]
    for k, task in enumerate(mission.tasks):
        item = f"tasks[{k}].eligible"
        for unknown in (number for number in task.eligible if number not in ids):
            yield BadInput(
                f"task {task.id} names an eligible vehicle that does not exist",
                where=where(item),
                item=item,
                expected="one of " + ", ".join(map(str, ids)),
                got=str(unknown),
            )
        item = f"tasks[{k}].points"
        if task.kind in ONE_POINT and len(task.points) != 1:
            yield BadInput(
                f"a {task.kind} task has one point",
                where=where(item),
                item=item,
                expected="1 point",
                got=f"{len(task.points)}",
            )
        if task.kind == TaskKind.LINE_SEARCH and len(set(task.points)) < 2:
            yield BadInput(
                "a line_search task needs a line",
                where=where(item),
                item=item,
                expected="2 or more different points",
                got=f"{len(set(task.points))}",
            )
        if task.kind == TaskKind.AREA_SEARCH:
            problem = polygon_problem([point[:2] for point in task.points])
            if problem:
                yield BadInput(
                    f"the area of task {task.id} is not a valid polygon: {problem}",
                    where=where(item),
                    item=item,
                    expected="a simple polygon, edges meeting only at shared corners",
                    got=problem,
                )
        if task.kind == TaskKind.PATTERN_SEARCH and task.pattern is None:
            item = f"tasks[{k}].pattern"
            yield BadInput(
                "a pattern_search task needs a pattern",
                where=where(item),
                item=item,
                expected="one of " + ", ".join(Pattern),
                got="none",
            )
        if task.kind == TaskKind.PATTERN_SEARCH and not task.extent_m > 0:
            item = f"tasks[{k}].extent_m"
            yield BadInput(
                "a pattern_search task needs an extent",
                where=where(item),
                item=item,
                expected="more than 0 m",
                got=f"{task.extent_m:g} m",
            )
        if task.kind == TaskKind.LOITER and task.duration_ms <= 0:
            item = f"tasks[{k}].duration_s"
            yield BadInput(
                "a loiter task needs a duration",
                where=where(item),
                item=item,
                expected="more than 0 s",
                got=f"{task.duration_ms / 1000:g} s",
            )


def _zones(mission: Mission, where: Where) -> Iterator[BadInput]:
    for k, zone in enumerate(mission.zones):
        item = f"zones[{k}].vertices"
        problem = polygon_problem(zone.vertices)
        if problem:
            yield BadInput(
                f"zone {zone.id} is not a valid polygon: {problem}",
                where=where(item),
                item=item,
                expected="a simple polygon, edges meeting only at shared corners",
                got=problem,
            )
        if zone.floor_m >= zone.ceiling_m:
            item = f"zones[{k}].ceiling_m"
            yield BadInput(
                f"zone {zone.id} has no height",
                where=where(item),
                item=item,
                expected=f"a ceiling above the floor of {zone.floor_m:g} m",
                got=f"{zone.ceiling_m:g} m",
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


def _places(mission: Mission, where: Where) -> Iterator[BadInput]:
    frame = mission.frame
    for item, point in _points(mission):
        north, east = point[0], point[1]
        if not (isfinite(north) and isfinite(east)):
            continue
        distance = hypot(north, east)
        if distance > MAX_REACH_M:
            yield BadInput(
                "too far from the frame's origin",
                where=where(item),
                item=item,
                expected=f"at most {MAX_REACH_M / 1000:g} km",
                got=f"{distance / 1000:.1f} km",
            )
        near = max(abs(frame.latitude_deg), abs(frame.longitude_deg)) > 3
        if near and abs(north - frame.latitude_deg) < 1 and abs(east - frame.longitude_deg) < 1:
            yield BadInput(
                "degrees where metres are meant",
                where=where(item),
                item=item,
                expected="north_m and east_m from the frame's origin, "
                "or latitude_deg and longitude_deg",
                got=f"{north:g}, {east:g}, which is the frame's own latitude and longitude",
            )


def _numbers(mission: Mission, where: Where) -> Iterator[BadInput]:
    for item, point in _points(mission):
        if not all(isfinite(value) for value in point):
            yield BadInput(
                "not a finite number",
                where=where(item),
                item=item,
                expected="finite numbers",
                got=", ".join(map(repr, point)),
            )
    volume = mission.daa.well_clear
    for name in ("dthr_m", "zthr_m", "tthr_s", "tcoa_s"):
        value = getattr(volume, name)
        if not (isfinite(value) and value >= 0):
            item = f"daa.well_clear.{name}"
            yield BadInput(
                "a threshold is negative or not finite",
                where=where(item),
                item=item,
                expected="0 or more",
                got=f"{value:g}",
            )


def _instances(mission: Mission, where: Where) -> Iterator[BadInput]:
    known = [vehicle.id for vehicle in mission.vehicles]
    for number in mission.instances:
        if number not in known:
            yield BadInput(
                "an ICAROUS instance for a vehicle that does not exist",
                where=where("bridge.instances"),
                item="bridge.instances",
                expected=", ".join(map(str, known)),
                got=str(number),
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
    """What is wrong with the process algebra, with a caret under the place."""
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


def change_problems(mission: Mission, where: Where) -> Iterator[BadInput]:
    """Changes in flight of vehicles or tasks that do not exist, and a mission that begins empty."""
    vehicles, tasks = {v.id for v in mission.vehicles}, {t.id for t in mission.tasks}
    for k, change in enumerate(mission.changes):
        known = vehicles if change.vehicle else tasks
        number = change.vehicle or change.task
        if number and number not in known:
            yield BadInput(
                f"{'vehicle' if change.vehicle else 'task'} {number} does not exist",
                where=where(f"changes[{k}].{change.kind}"),
                item=f"changes[{k}].{change.kind}",
                expected="one of " + ", ".join(map(str, sorted(known))),
                got=str(number),
            )
    later = [c for c in mission.changes if c.kind in (changes.TASK_ADDED, changes.VEHICLE_JOINS)]
    for all_of, name in ((vehicles, "vehicle"), (tasks, "task")):
        if all_of and all_of <= {getattr(c, name) for c in later}:
            yield BadInput(
                f"the mission begins without a {name}",
                where=where("changes"),
                item="changes",
                expected=f"a {name} that takes part from the start",
                got="all of them come later",
            )


def zone_end_problems(mission: Mission, where: Where) -> Iterator[BadInput]:
    """Ends in flight of zones that do not exist, have ended before, or bind no leg until then."""
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
        yield BadInput(what, where=where(item), item=item, expected=expected, got=got)


def start_problems(mission: Mission, where: Where) -> Iterator[BadInput]:
    """Vehicles whose start is inside a keep-out or not inside a keep-in (padding included)."""
    for k, vehicle in enumerate(mission.vehicles):
        for zone in mission.zones:
            if not start_is_allowed(vehicle.position, zone):
                out = zone.kind == ZoneKind.KEEP_OUT
                item = f"vehicles[{k}].position"
                yield BadInput(
                    f"vehicle {vehicle.id} starts "
                    + (
                        f"inside keep-out zone {zone.id}"
                        if out
                        else f"outside keep-in zone {zone.id}"
                    ),
                    where=where(item),
                    item=item,
                    expected=f"a start {'outside' if out else 'strictly inside'} it"
                    + f" (between {zone.floor_m:g} and {zone.ceiling_m:g} m MSL)",
                    got=_place(vehicle.position),
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
