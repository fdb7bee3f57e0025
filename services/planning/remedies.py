"""Remedies for a left-out task: minimal sets of changes that would make it possible, each tried.

For a task that no vehicle can do or reach, the options are recomputed without a zone, for vehicles that are
not eligible, and with two such changes where one does not suffice. These remedies are computed; those that
cannot be tried here (a lost vehicle, less wind, another time window) are listed and marked as untried.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

from cratous.core.assignment.problem import START
from cratous.core.routing.visibility import name_of
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.options import expand
from cratous.services.planning.routes import Routes
from cratous.spec.mission import AREAS, Zone
from cratous.spec.mission.plan import ELIGIBILITY, VEHICLE, WIND, ZONE, Remedy

ZONES_MOST = 8
"""Most zones removed, singly and in pairs."""


class _Change(NamedTuple):
    """One change: a zone removed, or all vehicles eligible."""

    kind: str
    zone: Zone | None
    text: str


def remedies_of(inputs: Inputs, task_id: int) -> tuple[Remedy, ...]:
    """The smallest sets of changes with which some vehicle could do and reach a task, as far as is known."""
    if task_id in inputs.undone:
        return ()  # it was begun and given up: no change brings it back
    singles = list(_changes(inputs, task_id))
    # paths over an area are slow to compute: pairs of changes are not tried
    for size in (1,) if inputs.mission.task(task_id).kind in AREAS else (1, 2):
        found = [
            _remedy(inputs, task_id, changes, able)
            for changes in combinations(singles, size)
            if (able := _able(inputs, task_id, changes))
        ]
        if found:
            return (*found, *_absent(inputs, task_id))
    return tuple(_absent(inputs, task_id))


def _changes(inputs: Inputs, task_id: int) -> Iterator[_Change]:
    named = inputs.mission.task(task_id).eligible
    if any(vehicle.id not in named for vehicle in inputs.mission.vehicles) and named:
        yield _Change(ELIGIBILITY, None, "another vehicle is eligible")
    for zone in inputs.zones[:ZONES_MOST]:
        yield _Change(ZONE, zone, f"without {name_of(zone)}")


def _able(inputs: Inputs, task_id: int, changes: tuple[_Change, ...]) -> tuple[int, ...]:
    """The vehicles that could do the whole task from their positions, with these changes."""
    gone = {change.zone.id for change in changes if change.zone is not None}
    zones = tuple(zone for zone in inputs.zones if zone.id not in gone)
    task = inputs.mission.task(task_id)
    if any(change.kind == ELIGIBILITY for change in changes):
        task = replace(task, eligible=())
    options, _ = expand(inputs.mission, [task], zones, in_part=False)
    routes = Routes(inputs.mission, inputs.starts, options, zones, inputs.flying)
    return tuple(
        vehicle.id
        for v, vehicle in enumerate(inputs.mission.vehicles)
        if any(
            vehicle.id in option.vehicles and routes.travel_ms(v, START, k) is not None
            for k, option in enumerate(options)
        )
    )


def _remedy(
    inputs: Inputs, task_id: int, changes: tuple[_Change, ...], able: tuple[int, ...]
) -> Remedy:
    kinds = tuple(dict.fromkeys(change.kind for change in changes))
    zones = tuple(change.zone.id for change in changes if change.zone is not None)
    who = ", ".join(f"vehicle {number}" for number in able)
    text = f"{' and '.join(change.text for change in changes)} {who} could do it"
    if kinds == (ELIGIBILITY,):
        text = f"if it were eligible, {who} could do it"
    return Remedy(kinds, text, zones=zones, vehicles=able, tried=True)


def _absent(inputs: Inputs, task_id: int) -> Iterator[Remedy]:
    """The eligible vehicles that take no part: whether they could do it was not tried."""
    named = inputs.mission.task(task_id).eligible
    for number, why in inputs.absent.items():
        if not named or number in named:
            windy = "wind" in why
            text = f"less wind for vehicle {number}" if windy else f"vehicle {number} takes part"
            yield Remedy((WIND if windy else VEHICLE,), f"{text} ({why})", vehicles=(number,))
