"""Changes that become known while a mission is flown, and the mission as known at an instant."""

from __future__ import annotations

from collections.abc import Iterable, Set
from dataclasses import dataclass, replace

from cratous.spec import algebra
from cratous.spec.algebra import ALTERNATIVE, Atom, Term
from cratous.spec.algebra.meaning import tasks
from cratous.spec.algebra.partial import after_choices
from cratous.spec.mission import Change, Mission, SweptZone, Zone

VEHICLE_LOST, VEHICLE_JOINS = "vehicle_lost", "vehicle_joins"
TASK_ADDED, TASK_REMOVED = "task_added", "task_removed"
ZONE, ZONE_ENDS = "zone", "zone_ends"
WIND = "wind"
VEHICLE_HOLDS, VEHICLE_RESUMES = DIRECT = "vehicle_holds", "vehicle_resumes"
"""Commands to one vehicle; the known mission and its plan stay unchanged."""
VEHICLE_LANDED, VEHICLE_FAILED = "vehicle_landed", "vehicle_failed"
"""Not in mission files: consequences of the flight itself."""


@dataclass(frozen=True)
class WindChange(Change):
    """This wind blows from now on and replaces any earlier one; there is no wind at the start."""

    north_m_s: float = 0.0
    east_m_s: float = 0.0


@dataclass(frozen=True)
class ZoneEnd(Change):
    """The zone with this id no longer applies from now on. A leg already begun is still checked against it."""

    zone_id: int = 0


@dataclass(frozen=True)
class HoldCommand(Change):
    """The vehicle flies to a place and circles there until it resumes its plan; without a place, where it is.

    place: north, east [m]; alt_m: above mean sea level [m]; None: its altitude at that time.
    """

    place: tuple[float, float] | None = None
    alt_m: float | None = None


def words(change: Change) -> str:
    """A change in words."""
    if isinstance(change.zone, SweptZone):
        return f"moving zone {change.zone.id} has moved on"
    if change.kind == ZONE and change.zone is not None:
        kind = change.zone.kind.value.replace("_", "-")
        label = f" ({change.zone.label})" if change.zone.label else ""
        return f"{kind} zone {change.zone.id}{label} appears"
    if isinstance(change, WindChange):
        return f"wind to {change.north_m_s:g} m/s north, {change.east_m_s:g} m/s east"
    if isinstance(change, ZoneEnd):
        return f"zone {change.zone_id} ends"
    if isinstance(change, HoldCommand):
        where = "where it is"
        if change.place is not None:
            where = f"at north {change.place[0]:g} m, east {change.place[1]:g} m"
        height = "" if change.alt_m is None else f", altitude {change.alt_m:g} m"
        return f"vehicle {change.vehicle} is commanded to hold {where}{height}"
    return {
        VEHICLE_RESUMES: f"vehicle {change.vehicle} is commanded to resume its plan",
        VEHICLE_LOST: f"vehicle {change.vehicle} is lost",
        VEHICLE_JOINS: f"vehicle {change.vehicle} joins",
        VEHICLE_LANDED: f"vehicle {change.vehicle} has landed",
        VEHICLE_FAILED: f"vehicle {change.vehicle} has declared a failure",
        TASK_ADDED: f"task {change.task} is requested",
        TASK_REMOVED: f"task {change.task} is removed",
    }[change.kind]


def requested_ms(mission: Mission, task: int) -> int | None:
    """When a task that was not part of the mission at the start was first requested [ms]; None for the others."""
    mine = [c for c in mission.changes if c.task == task and c.kind in (TASK_ADDED, TASK_REMOVED)]
    first = min(mine, key=lambda change: change.at_ms, default=None)
    return first.at_ms if first is not None and first.kind == TASK_ADDED else None


def split(changes: Iterable[Change], now_ms: int) -> tuple[list[Change], list[Change]]:
    """The changes known at an instant, and those still to come, each in order of time."""
    row = sorted(changes, key=lambda change: change.at_ms)
    return [c for c in row if c.at_ms <= now_ms], [c for c in row if c.at_ms > now_ms]


def known_at(mission: Mission, now_ms: int, done: Iterable[int] = ()) -> Mission:
    """The mission as known at an instant: the zones that have not ended, and the vehicles and tasks that take part.

    A vehicle takes part until it is lost, and from when it joins; a task from when it is requested until it is
    removed, unless it is in `done`. The latest change applies; a vehicle or task whose first change is to join or to
    be requested was not part of the mission before. Relations lose the tasks that do not take part.
    """
    if all(change.kind in DIRECT for change in mission.changes):
        return replace(mission, changes=()) if mission.changes else mission
    happened, _ = split(mission.changes, now_ms)
    appeared = (c.zone for c in happened if c.kind == ZONE and c.zone is not None)
    ended = {c.zone_id for c in happened if isinstance(c, ZoneEnd)}
    away = without_vehicles(mission, now_ms)
    known = _without_tasks(mission, _gone(mission, now_ms).keys() - set(done))
    return replace(
        known,
        zones=tuple(z for z in in_force(mission.zones, appeared) if z.id not in ended),
        vehicles=tuple(v for v in mission.vehicles if v.id not in away),
        changes=(),
    )


def is_next(zone: Zone, new: Zone) -> bool:
    """Whether the second is a later region of the moving zone of the first."""
    return isinstance(zone, SweptZone) and isinstance(new, SweptZone) and zone.id == new.id


def in_force(zones: Iterable[Zone], new: Iterable[Zone]) -> tuple[Zone, ...]:
    """Zones with new ones added; the region of a moving zone takes the place of its previous one."""
    found = list(zones)
    for zone in new:
        at = next((k for k, z in enumerate(found) if is_next(z, zone)), None)
        if at is None:
            found.append(zone)
        else:
            found[at] = zone
    return tuple(found)


def asked_by(mission: Mission, now_ms: int, done: Iterable[int] = ()) -> Mission:
    """The mission with all tasks that it requires, including those requested only after an instant, but without those
    removed by then, unless they are in `done`.
    """
    later = {c.task for c in mission.changes if c.kind == TASK_ADDED and c.at_ms > now_ms}
    return _without_tasks(mission, _gone(mission, now_ms).keys() - set(done) - later)


def with_choices(mission: Mission, begun: Set[int]) -> Mission:
    """The mission with each `+` resolved of which a task has begun: other operands may no longer begin."""
    if not begun or ALTERNATIVE not in mission.relations:
        return mission
    ids = frozenset(task.id for task in mission.tasks)
    term = algebra.parse(mission.relations, ids, where=mission.source)
    made = after_choices(term, begun)
    kept = set(tasks(made))
    return replace(
        mission,
        tasks=tuple(task for task in mission.tasks if task.id in kept),
        relations=algebra.format_term(made),
    )


def without_vehicles(mission: Mission, now_ms: int) -> dict[int, Change]:
    """The vehicles that do not take part at an instant, each with the change that is the reason."""
    return _out(mission, now_ms, "vehicle", VEHICLE_JOINS, VEHICLE_LOST)


def _gone(mission: Mission, now_ms: int) -> dict[int, Change]:
    return _out(mission, now_ms, "task", TASK_ADDED, TASK_REMOVED)


def _out(mission: Mission, now_ms: int, what: str, enters: str, leaves: str) -> dict[int, Change]:
    """The vehicles or tasks that do not take part, by the last change so far, else by the first to come."""
    found: dict[int, Change] = {}
    happened, to_come = split((c for c in mission.changes if c.kind in (enters, leaves)), now_ms)
    for change in reversed(to_come):
        found[getattr(change, what)] = change
    for change in happened:
        found[getattr(change, what)] = change
    return {
        number: change
        for number, change in found.items()
        if change.kind == (leaves if change.at_ms <= now_ms else enters)
    }


def _without_tasks(mission: Mission, gone: Set[int]) -> Mission:
    return replace(
        mission,
        tasks=tuple(t for t in mission.tasks if t.id not in gone),
        relations=_relations(mission, gone),
    )


def _relations(mission: Mission, gone: Set[int]) -> str:
    if not mission.relations.strip():
        return ""
    ids = [task.id for task in mission.tasks]
    term = algebra.parse(mission.relations, frozenset(ids), where=mission.source)
    left = _without(term, gone)
    return "" if left is None else algebra.format_term(left)


def _without(term: Term, gone: Set[int]) -> Term | None:
    """The term without these tasks; None if nothing is left. An operator with one operand stays."""
    if isinstance(term, Atom):
        return None if term.task in gone else term
    parts = tuple(part for part in (_without(a, gone) for a in term.operands) if part is not None)
    return replace(term, operands=parts) if parts else None
