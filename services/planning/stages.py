"""The stages of planning as pure functions: check, expand, route, assign, build.

The planning services call these; each stage's result is plain data.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import Any

from cratous.core.assignment.problem import START, Assignment, Branch, Fixed, without_order
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.visibility import circle, name_of, start_point
from cratous.services.planning.options import Option
from cratous.services.planning.routes import Routes
from cratous.spec import algebra
from cratous.spec.algebra import meaning as algebra_meaning
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission import Mission, Zone, asked
from cratous.spec.mission.plan import Hold, Plan, PlanItem, Pose

BRANCH_LIMIT = 64
"""Most resolutions of `+` examined to determine which routes between tasks are needed."""


def start_poses(mission: Mission, given: Mapping[int, Pose] | None = None) -> dict[int, Pose]:
    """Start pose of each vehicle: the given one, else the mission's."""
    poses = {v.id: Pose(*v.position, v.heading_rad) for v in mission.vehicles}
    poses.update(given or {})
    return poses


def check_starts(mission: Mission, starts: Mapping[int, Pose], zones: Sequence[Zone]) -> None:
    """BadInput if a vehicle starts inside a keep-out or outside a keep-in zone."""
    for k, vehicle in enumerate(mission.vehicles):
        bad = first_bad_leg((start_point(starts[vehicle.id]),), zones)
        if bad is not None:
            keep_in = bad[1].kind.value == "keep_in"
            where = "outside of" if keep_in else "inside"
            raise BadInput(
                f"vehicle {vehicle.id} starts {where} {name_of(bad[1])}",
                where=mission.source,
                item=f"vehicles[{k}].position",
                expected=f"a start {'inside' if keep_in else 'outside of'} it",
                got=f"north {starts[vehicle.id].north_m:.1f} m, "
                f"east {starts[vehicle.id].east_m:.1f} m, alt {starts[vehicle.id].alt_m:.1f} m",
            )


def term_of(mission: Mission) -> algebra.Term:
    """The mission's relations as a term; all tasks in any order if there are none. NoPlan without tasks."""
    term = asked.term_of(mission)
    if term is None:
        raise NoPlan(("the mission has no tasks",))
    return term


def fixed_tasks(done: Iterable[Any]) -> tuple[Fixed, ...]:
    """Tasks already flown, from anything with (task_id, start_ms, end_ms) or those attributes."""
    made = []
    for item in done:
        if hasattr(item, "task_id"):
            made.append(Fixed(item.task_id, item.start_ms, item.end_ms))
        else:
            made.append(Fixed(*item))
    return tuple(made)


def branches_of(mission: Mission, fixed: Sequence[Fixed]) -> tuple[tuple[Branch, ...], bool]:
    """The branches that contain all flown tasks, and whether all branches were examined."""
    term = term_of(mission)
    done = {f.task_id for f in fixed}
    made = []
    for resolved in islice(algebra_meaning.branches(term), BRANCH_LIMIT):
        tasks = algebra_meaning.tasks(resolved)
        if not done <= set(tasks):
            continue
        rows = tuple(row for row in algebra_meaning.rows(resolved) if row.i not in done)
        if mission.order == "order":
            rows = without_order(rows)
        made.append(Branch(tasks, rows))
    return tuple(made), algebra_meaning.count_branches(term) <= BRANCH_LIMIT


def hold_of(option: Option, wait_ms: int, zones: Sequence[Zone]) -> Hold | None:
    """A holding circle at the option's start whose laps take exactly wait_ms [ms] and keep the zones; None if
    there is none.
    """
    pose, speed = option.start, option.flyer.speed_m_s
    for laps in range(wait_ms // option.lap_ms, 0, -1):
        radius = speed * wait_ms / 1000 / (2 * math.pi * laps)
        for room in option.holds:
            if radius > room.radius_m * (1 + 1e-9):
                continue
            if first_bad_leg(circle(pose, radius, room.clockwise), zones) is not None:
                continue
            side = pose.heading_rad + (math.pi / 2 if room.clockwise else -math.pi / 2)
            return Hold(
                pose.north_m + radius * math.cos(side),
                pose.east_m + radius * math.sin(side),
                pose.alt_m,
                radius,
                room.clockwise,
            )
    return None


def build(
    mission: Mission,
    options: Sequence[Option],
    routes: Routes,
    result: Assignment,
    zones: Sequence[Zone],
    fixed: Sequence[Fixed] = (),
) -> Plan:
    """The plan of an assignment: transits, holds, paths and times. NoPlan if a hold has no room."""
    branch = result.branch
    at: dict[int, int] = {}
    items = []
    for placed in result.placed:
        option = options[placed.candidate]
        vehicle = mission.vehicles[placed.vehicle]
        way = routes.route(placed.vehicle, at.get(placed.vehicle, START), placed.candidate)
        wait = placed.start_ms - placed.arrive_ms
        hold = hold_of(option, wait, zones) if wait > 0 else None
        if wait > 0 and hold is None:
            raise NoPlan(
                (
                    f"vehicle {vehicle.id} has to wait {wait / 1000:.3f} s before task "
                    f"{option.task_id}, and no hold circle there obeys the zones",
                )
            )
        items.append(
            PlanItem(
                task_id=option.task_id,
                option_id=option.option_id,
                vehicle_id=vehicle.id,
                transit=way.points,
                path=option.path,
                hold=hold,
                speed_m_s=option.flyer.speed_m_s,
                depart_ms=placed.depart_ms,
                arrive_ms=placed.arrive_ms,
                wait_ms=wait,
                start_ms=placed.start_ms,
                end_ms=placed.end_ms,
                end_heading_rad=option.end.heading_rad,
                view_elevation_rad=option.view_elevation_rad,
                view_azimuth_rad=option.view_azimuth_rad,
            )
        )
        at[placed.vehicle] = placed.candidate
    return Plan(
        mission=mission.name,
        items=tuple(items),
        rows=branch.rows,
        chosen=branch.tasks,
        makespan_ms=max([item.end_ms for item in items] + [f.end_ms for f in fixed], default=0),
        cost=mission.cost,
        nodes=result.nodes,
        exhausted=result.status == "optimal",
        status=result.status,
        bound=result.bound,
        certificate=result.digest,
    )


def nothing_left(mission: Mission, branches: Sequence[Branch], fixed: Sequence[Fixed]) -> Plan:
    """The plan when every task has been flown; NoPlan if the flown tasks fit no branch."""
    if not branches:
        raise NoPlan(("what has been flown fits no branch of the relations",))
    first, last = branches[0], max((f.end_ms for f in fixed), default=0)
    return Plan(mission.name, (), first.rows, first.tasks, last, mission.cost, 0, True, "optimal")


def nothing_asked(mission: Mission) -> Plan:
    """The plan when all tasks have been withdrawn in flight."""
    return Plan(mission.name, (), (), (), 0, mission.cost, 0, True, "optimal")
