"""What becomes known while a mission is flown, and the mission as it is known at an instant."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from cratous.spec import algebra
from cratous.spec.algebra import Atom, Term
from cratous.spec.mission import Change, Mission
from cratous.spec.wind import WindChange

VEHICLE_LOST, VEHICLE_JOINS = "vehicle_lost", "vehicle_joins"
TASK_ADDED, TASK_REMOVED = "task_added", "task_removed"
ZONE = "zone"


def words(change: Change) -> str:
    """A change in words."""
    if change.kind == ZONE and change.zone is not None:
        kind = change.zone.kind.value.replace("_", "-")
        label = f" ({change.zone.label})" if change.zone.label else ""
        return f"{kind} zone {change.zone.id}{label} appears"
    if isinstance(change, WindChange):
        return f"wind to {change.north_m_s:g} m/s north, {change.east_m_s:g} m/s east"
    return {
        VEHICLE_LOST: f"vehicle {change.vehicle} is lost",
        VEHICLE_JOINS: f"vehicle {change.vehicle} joins",
        TASK_ADDED: f"task {change.task} is requested",
        TASK_REMOVED: f"task {change.task} is removed",
    }[change.kind]


def split(changes: Iterable[Change], now_ms: int) -> tuple[list[Change], list[Change]]:
    """The changes that are known at an instant, and those to come, each in the order of time."""
    row = sorted(changes, key=lambda change: change.at_ms)
    return [c for c in row if c.at_ms <= now_ms], [c for c in row if c.at_ms > now_ms]


def known_at(mission: Mission, now_ms: int, done: Iterable[int] = ()) -> Mission:
    """The mission as it is known at an instant: its zones, and who and what takes part.

    A vehicle takes part until it is lost, and from when it joins; a task from when it is requested until it
    is removed, unless it is among those `done`. Relations lose the tasks that do not take part.
    """
    if not mission.changes:
        return mission
    flown = set(done)
    gone_vehicles, gone_tasks, zones = set(), set(), list(mission.zones)
    for change in mission.changes:
        happened = change.at_ms <= now_ms
        if change.kind == ZONE and happened and change.zone is not None:
            zones.append(change.zone)
        elif (change.kind == VEHICLE_LOST and happened) or (
            change.kind == VEHICLE_JOINS and not happened
        ):
            gone_vehicles.add(change.vehicle)
        elif (change.kind == TASK_REMOVED and happened and change.task not in flown) or (
            change.kind == TASK_ADDED and not happened
        ):
            gone_tasks.add(change.task)
    return replace(
        mission,
        zones=tuple(zones),
        vehicles=tuple(v for v in mission.vehicles if v.id not in gone_vehicles),
        tasks=tuple(t for t in mission.tasks if t.id not in gone_tasks),
        relations=_relations(mission, gone_tasks),
        changes=(),
    )


def _relations(mission: Mission, gone: set[int]) -> str:
    if not mission.relations.strip():
        return ""
    ids = [task.id for task in mission.tasks]
    term = algebra.parse(mission.relations, frozenset(ids), where=mission.source)
    left = _without(term, gone)
    return "" if left is None else algebra.format_term(left)


def _without(term: Term, gone: set[int]) -> Term | None:
    """The term without these tasks; None if nothing is left. An operator with one operand stays."""
    if isinstance(term, Atom):
        return None if term.task in gone else term
    parts = tuple(part for part in (_without(a, gone) for a in term.operands) if part is not None)
    return replace(term, operands=parts) if parts else None
