"""Validation of an automation request against what is known: the kernels of `core.contracts.validity`.

The service only looks objects up; the proved kernels decide whether each is as required, and whether the
request is valid. A task is known if it and the place that it names are known. Whether a plan exists is not
checked here: vehicles that cannot fly as configured and invalid relations are reported by the planning
services.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

from cratous.core.contracts.validity import NOT_READY, item_fault, request_valid
from cratous.services.pipeline.source import Known

VEHICLE, TASK, REGION, ZONE = 1, 2, 3, 4
_NAMES = {VEHICLE: "vehicle", TASK: "task", REGION: "operating region", ZONE: "zone"}
_PLACES = {"LineID": "line", "SearchAreaID": "area", "SearchLocationID": "point"}
"""The fields by which a task names a place of interest, and its sort; 0 names none."""


class Thing(NamedTuple):
    """One object that a request names: its properties for the kernels, its id, the unknown object that it
    names (lacks), and its kind if no service handles that (nobody).
    """

    kind: int
    known: bool
    ready: bool
    given: bool
    number: int
    lacks: str = ""
    nobody: str = ""

    @property
    def fault(self) -> int:
        """What is wrong with it: 0 nothing, 1 unknown, 2 not ready."""
        return item_fault(self.kind, self.known, self.ready, self.given)

    def __str__(self) -> str:
        name = f"{_NAMES[self.kind]} {self.number}"
        if self.nobody:
            return f"{name} is a {self.nobody}: no service here does this kind, and no other speaks for it"
        if self.lacks:
            return f"{name} names {self.lacks}, which does not exist"
        if self.fault != NOT_READY:
            return f"{name} does not exist"
        if self.kind == VEHICLE:
            return f"the state of {name} is not known"
        return f"{name} has not initialised itself"


class Verdict(NamedTuple):
    """valid: it can be planned; waits: it lacks only tasks that have not initialised themselves."""

    valid: bool
    waits: bool
    reasons: tuple[str, ...]


def things_of(
    request: Any,
    given: Collection[int],
    world: Known,
    initialised: Collection[int],
    unserved: Mapping[int, str] = {},
) -> list[Thing]:
    """Everything that an AutomationRequest names; an empty EntityList means all vehicles.

    given: vehicles whose state is part of the request; initialised: tasks that have reported so; unserved:
    kinds of tasks without a service.
    """
    vehicles = list(request.EntityList) or world.ids("configuration")
    made = [
        Thing(VEHICLE, world.has("configuration", v), world.has("state", v), v in given, v)
        for v in vehicles
    ]
    for number in request.TaskList:
        lacks = _lacking(world, number)
        nobody = unserved.get(number, "")
        known = world.has("task", number) and not lacks and not nobody
        made.append(Thing(TASK, known, number in initialised, False, number, lacks, nobody))
    number = request.OperatingRegion
    if number:  # region 0 means all known zones
        region = world.get("region", number)
        made.append(Thing(REGION, region is not None, True, False, number))
        if region is not None:
            zones = [*region.KeepInAreas, *region.KeepOutAreas]
            made += [Thing(ZONE, world.has("zone", z), True, False, z) for z in zones]
    return made


def _lacking(world: Known, task: int) -> str:
    """The place of interest that a task names and that is unknown; "" if there is none."""
    body = world.get("task", task)
    for field, sort in _PLACES.items():
        number = getattr(body, field, 0)
        if number and not world.has(sort, number):
            return f"{sort} {number}"
    return ""


def verdict(things: list[Thing]) -> Verdict:
    """Whether the request can be planned, and why not."""
    if request_valid([thing[:4] for thing in things]):
        return Verdict(True, False, ())
    wrong = [thing for thing in things if thing.fault]
    reasons = [str(thing) for thing in wrong]
    kinds = {thing.kind for thing in things}
    if VEHICLE not in kinds:
        reasons.append("there is no vehicle")
    if TASK not in kinds:
        reasons.append("the request names no task")
    waits = {VEHICLE, TASK} <= kinds and all(t.kind == TASK and t.fault == NOT_READY for t in wrong)
    return Verdict(False, waits, tuple(reasons))
