"""The rows that each requirement promises for a mission, and those of them that are missing.

They follow from the mission and the observed duration of the flight, never from what a planner
accepted or a log happens to contain. A promised row without a verdict is unknown: not observed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Set
from itertools import combinations
from typing import NamedTuple

from cratous.services.mission.landing import on_failure_of
from cratous.services.mission.merging import merging_of
from cratous.services.mission.take_off import grounded
from cratous.services.mission.zone_times import judged_zones
from cratous.services.monitor.observation import Span, in_the_air
from cratous.services.monitor.plan_check import WHOLE
from cratous.services.monitor.relations import first_choices
from cratous.spec.mission import Mission, MovingZone, Zone
from cratous.spec.mission.asked import asked
from cratous.spec.mission.changes import asked_by
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict

CHOICE = "flight: no task of another choice of the relations"
END = "end of mission"
WAYS = {"Down": "to", "Up": "from"}


class Row(NamedTuple):
    """A promised row: requirement, subject, and the mission vehicles concerned."""

    requirement: str
    item: str
    vehicles: tuple[int, ...] = ()


PLAN_ROWS = (Row("G1", WHOLE), Row("G1", "plan: all order and timing rows at once"))
"""Rows that the check before the flight yields for every plan."""


class Watched(NamedTuple):
    """What the promised rows depend on: the requested tasks, their mission, and the flight's duration."""

    mission: Mission
    asked: Mission
    tasks: tuple[int, ...]
    end_ms: int


def watched(mission: Mission, end_ms: int, done: Set[int], accepted: Set[int]) -> Watched:
    """What is judged of a flight that lasted until end_ms [ms]. done: tasks flown to their end;
    accepted: tasks of the last plan, used only to tell which branch of a `+` was chosen.
    """
    wanted = asked_by(mission, end_ms, done)
    return Watched(mission, wanted, asked(wanted, done, accepted), end_ms)


def fence_item(zone: Zone | MovingZone, vehicle: int) -> str:
    """Name of the row on a zone and a vehicle."""
    return f"zone: {zone.kind.value} {zone.id}, flight of vehicle {vehicle}"


def eligible_item(task: int) -> str:
    """Name of the row on the eligibility of the vehicle that flew a task."""
    return f"eligibility: task {task} in flight"


def merge_item(fix: str, one: int, other: int) -> str:
    """Name of the row on a pair of vehicles that merge at a fix."""
    return f"separation at {fix}: vehicles {one} and {other}"


def merging_pairs(mission: Mission) -> list[tuple[int, int]]:
    """All pairs of vehicles that merge."""
    merging = merging_of(mission)
    return [] if merging is None else list(combinations(sorted(merging.vehicles), 2))


def pair_item(own: int, other: int) -> str:
    """Name of the row on a pair of aircraft."""
    return f"well clear of {own} and {other}"


def alone_item(own: int) -> str:
    """Name of the row of a vehicle without traffic to keep well clear of."""
    return f"well clear of {own}"


def served_item(task: int) -> str:
    """Name of the row on the service of a task."""
    return f"task {task} served"


def authority_item(vehicle: int) -> str:
    """The name of the row on the authority over a vehicle."""
    return f"authority over vehicle {vehicle}"


def take_off_item(vehicle: int) -> str:
    """Name of the G4 row on how a vehicle takes off."""
    return f"take-off of vehicle {vehicle}"


def alone_without_link_item(vehicle: int) -> str:
    """Name of the G5 row on what a vehicle flies without the link."""
    return f"what vehicle {vehicle} flies without the link"


def circle_item(vehicle: int) -> str:
    """Name of the G5 row on the circle of a vehicle when a flight ends in the safe state."""
    return f"circle of vehicle {vehicle} at the end"


def failure_item(vehicle: int) -> str:
    """Name of the G4 row on what a vehicle does after a declared failure."""
    return f"what vehicle {vehicle} does after a failure"


def failure_due_item(vehicle: int) -> str:
    """Name of the G4 row on whether a vehicle declared each failure that was due."""
    return f"failures of vehicle {vehicle} are declared when due"


def beat_item(vehicle: int, way: str) -> str:
    """Name of the row on the heartbeats of a vehicle in one direction, `Down` or `Up`."""
    return f"heartbeat {WAYS[way]} the ICAROUS instance of {vehicle}"


def pairs_of(mission: Mission, end_ms: int) -> dict[tuple[int, int], Span]:
    """Pairs of aircraft with at least one protected, each with the span in which both are in the air."""
    step_ms = mission.simulation.step_ms
    ours = {v.id: v.protected for v in mission.vehicles}
    others: dict[int, Span] = dict.fromkeys(ours, (0, end_ms))
    for one in mission.traffic:
        there = in_the_air(one, step_ms, end_ms)
        if there is not None:
            others[one.id] = there
    return {
        (own, other): span
        for own in sorted(n for n, protected in ours.items() if protected)
        for other, span in sorted(others.items())
        if other != own and not (ours.get(other, False) and other < own)
    }


def relation_items(seen: Watched, present: Collection[str]) -> list[str]:
    """Names of the rows on order and timing: those of one branch of the requested tasks.

    If several branches have these tasks, the one with the fewest rows missing from `present` is
    taken.
    """
    best: list[str] | None = None
    for rows in first_choices(seen.asked, frozenset(seen.tasks)):
        items = [f"flight: {row.text}" for row in rows]
        lacking = set(items) - set(present)
        if not lacking:
            return items
        if best is None or len(lacking) < len(set(best) - set(present)):
            best = items
    return best or []


def promised(seen: Watched, present: Collection[str] = ()) -> Iterator[Row]:
    """Every row that a judged flight must have; present: the G1 items that it has."""
    mission, guarded = seen.mission, [v.id for v in seen.mission.vehicles if v.protected]
    for bound in judged_zones(mission, seen.end_ms):
        yield from (Row("G1", fence_item(bound.zone, vehicle), (vehicle,)) for vehicle in guarded)
    yield Row("G1", CHOICE)
    yield from (Row("G1", item) for item in relation_items(seen, present))
    for task in seen.tasks:
        yield Row("G1", eligible_item(task))
    if (merging := merging_of(mission)) is not None:
        for one, other in merging_pairs(mission):
            yield Row("G1", merge_item(merging.name, one, other), (one, other))
    pairs = pairs_of(mission, seen.end_ms)
    yield from (Row("G2", pair_item(*pair), pair) for pair in pairs)
    met = {number for pair in pairs for number in pair}
    yield from (Row("G2", alone_item(own), (own,)) for own in guarded if own not in met)
    yield from (Row("G3", served_item(task)) for task in seen.tasks)
    yield Row("G3", END)
    for vehicle in guarded:
        yield Row("G4", authority_item(vehicle), (vehicle,))
        yield from (Row("G5", beat_item(vehicle, way), (vehicle,)) for way in WAYS)
    taking_off = [one.id for one in grounded(mission) if one.id in mission.instances]
    yield from (Row("G4", take_off_item(vehicle), (vehicle,)) for vehicle in taking_off)
    if on_failure_of(mission) is not None:
        for vehicle in mission.instances:
            yield Row("G4", failure_item(vehicle), (vehicle,))
            yield Row("G4", failure_due_item(vehicle), (vehicle,))
    if mission.link_loss is not None:
        for vehicle in mission.instances:
            yield Row("G5", alone_without_link_item(vehicle), (vehicle,))


def missing(rows: Iterable[Row], present: Iterable[tuple[str, str]]) -> list[Verdict]:
    """An unknown verdict for each promised row that is not among (requirement, item)."""
    there = set(present)
    return [
        Verdict(
            row.requirement, row.item, Outcome.UNKNOWN, Kind.OBSERVED, "not observed",
            vehicles=row.vehicles,
        )
        for row in rows
        if (row.requirement, row.item) not in there
    ]  # fmt: skip
