"""Why no plan exists, in the user's terms: missing options, missing routes, rows that clash.

Timing conflicts are found by relaxing: without its upper bounds the mission has a plan; the
smallest set of bounds that still forbids one (deletion filter) is what is reported, with the
earliest end that the task in question can reach.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from cratous.core.assignment import Assignment, Branch, Problem, assign
from cratous.services.planning.options import Dropped, Option
from cratous.services.planning.routes import Routes
from cratous.spec.mission import Mission
from cratous.spec.plan import Row
from cratous.spec.schedule import NOT_AFTER, WITHIN_END, WITHIN_START

PROBES = 4_000
"""Nodes per question asked of the search while looking for reasons."""
UPPER = (WITHIN_END, WITHIN_START, NOT_AFTER)


def why_none(
    mission: Mission,
    wanted: Sequence[int],
    options: Sequence[Option],
    dropped: Sequence[Dropped],
    routes: Routes,
    problem: Problem,
    searched_all: bool,
) -> tuple[str, ...]:
    """The reasons why the search found nothing; says so if it did not search everything."""
    why = without_options(mission, wanted, options, dropped)
    why = why or without_routes(mission, wanted, options, routes)
    if why:
        return why
    why, certain = timing_reasons(problem)
    if not (certain and searched_all):
        why = (*why, f"no schedule was found in {problem.node_limit} search nodes")
    return why or ("no order of the tasks satisfies the relations",)


def without_options(
    mission: Mission, wanted: Sequence[int], options: Sequence[Option], dropped: Sequence[Dropped]
) -> tuple[str, ...]:
    """A reason for each wanted task that no vehicle can fly."""
    reasons = []
    for task_id in wanted:
        if any(option.task_id == task_id for option in options):
            continue
        causes: dict[tuple[int, str], None] = {}
        for drop in dropped:
            if drop.task_id == task_id:
                causes.update(((vehicle, drop.reason), None) for vehicle in drop.vehicles)
        said = "; ".join(f"vehicle {vehicle}: {reason}" for vehicle, reason in causes)
        label = mission.task(task_id).label
        named = f"task {task_id}" + (f" ({label})" if label else "")
        reasons.append(f"no vehicle can do {named}: {said or 'no vehicle is eligible'}")
    return tuple(reasons)


def without_routes(
    mission: Mission, wanted: Sequence[int], options: Sequence[Option], routes: Routes
) -> tuple[str, ...]:
    """A reason for each wanted task that no vehicle can reach, from its start or another task."""
    reasons = []
    for task_id in wanted:
        mine = [k for k, option in enumerate(options) if option.task_id == task_id]
        causes: dict[str, None] = {}
        reached = False
        for k in mine:
            for v, vehicle in enumerate(mission.vehicles):
                if vehicle.id not in options[k].vehicles:
                    continue
                before = [-1, *(j for j, other in enumerate(options) if other.task_id != task_id)]
                for j in before:
                    if routes.travel_ms(v, j, k) is not None:
                        reached = True
                        break
                if reached:
                    break
                causes[f"vehicle {vehicle.id}: {routes.route(v, -1, k).reason}"] = None
            if reached:
                break
        if mine and not reached:
            reasons.append(f"no vehicle can reach task {task_id}: " + "; ".join(causes))
    return tuple(reasons)


def _with_rows(problem: Problem, keep: set[Row], all_upper: set[Row]) -> Problem:
    branches = tuple(
        Branch(
            branch.tasks,
            tuple(row for row in branch.rows if row not in all_upper or row in keep),
            branch.allowed,
        )
        for branch in problem.branches
    )
    return replace(problem, branches=branches, node_limit=PROBES)


def timing_reasons(problem: Problem) -> tuple[tuple[str, ...], bool]:
    """Which upper bounds clash, and whether that is certain (every search was exhausted)."""
    upper = {row: None for branch in problem.branches for row in branch.rows if row.kind in UPPER}
    everything = set(upper)
    relaxed = assign(_with_rows(problem, set(), everything))
    if relaxed.placed is None:
        return (), relaxed.exhausted
    certain, keep = True, list(upper)
    for row in list(upper):
        trial = [other for other in keep if other is not row]
        found = assign(_with_rows(problem, set(trial), everything))
        if found.placed is None:
            certain, keep = certain and found.exhausted, trial
    reasons = []
    for row in keep:
        # everything but this one row: when does its task end at the earliest?
        others = set(keep) - {row}
        best, proved = _earliest_end(_with_rows(problem, others, everything), row.i)
        got = "no schedule was found"
        if best is not None:
            where = "" if proved else " that was found"
            got = f"the earliest end on any eligible vehicle{where} is {best / 1000:.1f} s"
        if row.kind == NOT_AFTER:
            bound = f"task {row.i} must end by {row.hi / 1000:.3f} s"
        else:
            what = "end" if row.kind == WITHIN_END else "start"
            names = ", ".join(f"task {task}" for task in row.group)
            bound = f"task {row.i} must end within {row.hi / 1000:.3f} s of the {what} of {names}"
        reasons.append(f"{bound} ({row.text}), but {got}")
    return tuple(reasons), certain


def _earliest_end(problem: Problem, task_id: int) -> tuple[int | None, bool]:
    """The earliest end of one task whatever the others do, and whether that is certain."""
    found: Assignment = assign(replace(problem, cost=f"END:{task_id}"))
    return (None if found.placed is None else found.cost), found.exhausted
