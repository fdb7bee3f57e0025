"""Whether a mission change in flight requires a new plan."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import islice

from cratous.core.executive.steps import change_counts
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.visibility import name_of
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState
from cratous.spec import executive
from cratous.spec.algebra.meaning import branches, rows
from cratous.spec.algebra.partial import waits_for
from cratous.spec.constraint_rows import AFTER_END
from cratous.spec.mission import Change, Mission, SweptZone, Zone
from cratous.spec.mission.asked import term_of
from cratous.spec.mission.changes import (
    TASK_ADDED,
    TASK_REMOVED,
    VEHICLE_FAILED,
    VEHICLE_JOINS,
    VEHICLE_LANDED,
    VEHICLE_LOST,
    ZONE_ENDS,
    ZoneEnd,
    with_choices,
)
from cratous.spec.mission.plan import Plan, in_part_of, left_out_of, left_out_text

BRANCHES_MAX = 64
"""Most resolutions of `+` that are checked for missed orders."""
KINDS = {
    VEHICLE_LOST: executive.LOST,
    VEHICLE_LANDED: executive.LOST,
    VEHICLE_FAILED: executive.LOST,
    VEHICLE_JOINS: executive.JOINS,
    TASK_ADDED: executive.ADDED,
    TASK_REMOVED: executive.REMOVED,
    ZONE_ENDS: executive.ZONE_ENDED,
}


def tasks_text(tasks: Sequence[int]) -> str:
    """Task ids in words: `task 2`, `tasks 2, 3`."""
    return f"task{'' if len(tasks) == 1 else 's'} {', '.join(map(str, tasks))}"


def left_by(chains: Mapping[int, Chain]) -> dict[int, list[int]]:
    """The tasks that each vehicle has still to complete."""
    return {c.vehicle.id: [i.task_id for i in c.items[max(c.k, 0) :]] for c in chains.values()}


def handed_over(before: Mapping[int, list[int]], plan: Plan) -> str:
    """What a new plan changes, in words: tasks given to other vehicles, dropped, and left out with the
    reasons.
    """
    gone = {one.task_id for one in left_out_of(plan)}
    who = {item.task_id: item.vehicle_id for item in plan.items}
    to: dict[int, list[int]] = {}
    out: list[int] = []
    for vehicle, tasks in sorted(before.items()):
        for task in (t for t in tasks if t not in gone):
            if task not in who:
                out.append(task)
            elif who[task] != vehicle:
                to.setdefault(who[task], []).append(task)
    parts = [f"{tasks_text(tasks)} to vehicle {vehicle}" for vehicle, tasks in sorted(to.items())]
    parts += [f"{tasks_text(out)} left out"] if out else []
    return "; ".join(filter(None, (*parts, left_out_text(plan))))


def nobody_may(known: Mission, left: Collection[int], absent: Mapping[int, str]) -> str:
    """The remaining tasks that no available vehicle is eligible for, and why, in words."""
    here = {vehicle.id for vehicle in known.vehicles}
    parts = []
    for task in (t for t in known.tasks if t.id in left):
        if here & set(task.eligible or here):
            continue
        away = [
            f"vehicle {v}: {why}" for v, why in absent.items() if v in (task.eligible or absent)
        ]
        parts.append(f"no vehicle that takes part may do task {task.id} ({'; '.join(away)})")
    return "; ".join(parts)


def undone_by(change: Change, plan: Plan, settled: Collection[int]) -> list[int]:
    """The unsettled tasks that the plan leaves out, or does only in part because of the zone that ends or has moved on.

    settled: tasks that have ended or were given up. Empty for other changes.
    """
    if isinstance(change, ZoneEnd):
        zone_id = change.zone_id
    elif isinstance(change.zone, SweptZone):
        zone_id = change.zone.id
    else:
        return []
    tasks = {one.task_id for one in left_out_of(plan)}
    tasks |= {one.task_id for one in in_part_of(plan) if zone_id in one.zones}
    return sorted(tasks.difference(settled))


def orders_missed(
    known: Mission, due: Sequence[Change], starts: Mapping[int, int], ends: Collection[int]
) -> str:
    """Orders that can no longer be met because a task had begun before a new one that it must follow, in
    words.
    """
    term = term_of(with_choices(known, set(starts)))
    if term is None:
        return ""
    new = {change.task for change in due if change.kind == TASK_ADDED}
    found: dict[str, None] = {}
    for branch in islice(branches(term), BRANCHES_MAX):
        for row in rows(branch):
            before = set(ends) if row.kind == AFTER_END else set(starts)
            missed = new & set(row.group) - before
            if row.i in starts and missed and waits_for(row, before):
                began = f"task {row.i} began at {starts[row.i] / 1000:.2f} s"
                found[f"{row.text} cannot be kept any more: {began}"] = None
    return "; ".join(found)


def touched_by(
    due: Sequence[Change],
    zones: Sequence[Zone],
    chains: Mapping[int, Chain],
    ended: Collection[int],
    states: Mapping[int, AirState],
    undone: Mapping[Change, Sequence[int]],
) -> str:
    """Why a change requires a new plan, in words; "" if it does not.

    The kernel `change_counts` decides which changes do by themselves; a new zone does if it breaks a leg
    still to be flown (kernels by `first_bad_leg`). ended: completed tasks; undone: the tasks of `undone_by`,
    by change.
    """
    left = left_by(chains)
    for change in due:
        moved_on = isinstance(change.zone, SweptZone)
        kind = executive.ZONE_ENDED if moved_on else KINDS.get(change.kind, executive.OTHER)
        tasks = undone.get(change, left.get(change.vehicle, []))
        if not change_counts(kind, len(tasks), change.task in ended):
            continue
        if kind == executive.LOST:
            return f"vehicle {change.vehicle} leaves {tasks_text(tasks)}"
        if kind == executive.ZONE_ENDED:
            where = "where it is now" if moved_on else "without it"
            return f"{tasks_text(tasks)} may be done, or done whole, {where}"
        if kind == executive.REMOVED:
            return f"task {change.task} is left out"
        return "what is left is shared out again"
    for vid, chain in sorted(chains.items()):
        ways = [(states[vid].position, *chain.track.rest(chain.s_m))]
        for item in chain.items[max(chain.k, 0) + 1 :]:
            ways += [item.transit, item.path]
        if chain.item is not None and chain.phase is not Phase.TASK:
            ways.append(chain.item.path)
        for way in ways:
            bad = first_bad_leg(way, zones) if way else None
            if bad is not None:
                return f"the way of vehicle {vid} breaks {name_of(bad[1])}"
    return ""
