"""The offers of a request as read from messages: options from TaskPlanOptions, routes from the
AssignmentCostMatrix.

Shared by the services that assign tasks and loiters. Missing options, and costs of options that were not
offered, are named errors.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

from cratous.core.assignment.problem import START, Branch
from cratous.services.loading.duplicates import counted_once
from cratous.services.pipeline.compositions import Pair, Split, composition, is_choice, split
from cratous.services.pipeline.contexts import Context
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.mission_assign import Travel
from cratous.services.planning.options import Dropped, Option, hold_rooms
from cratous.services.planning.performance_classes import flyer_of
from cratous.services.planning.routes import Routes
from cratous.spec.errors import BadInput
from cratous.spec.mission import Zone

OPTIONS = "uxas.messages.task.TaskPlanOptions"


class Told(NamedTuple):
    """Messages of one request: the request itself, and the options by task."""

    request: Any
    options: dict[int, Any]


class Offered(Inputs):
    """Inputs whose options are those offered in messages."""

    def __init__(
        self,
        base: Inputs,
        offered: tuple[Option, ...],
        known: bool,
        withheld: Mapping[int, tuple[Dropped, ...]],
    ) -> None:
        """known: options were computed here, so the dropped ones are known; withheld: dropped options of
        tasks that report them themselves.
        """
        super().__init__(
            base.mission, base.starts, base.fixed, base.now_ms, base.flying, base.absent,
            base.undone, base.begun,
        )  # fmt: skip
        self.offered, self._base, self._known = offered, base, known
        self._withheld = dict(withheld)

    @cached_property
    def options(self) -> tuple[Option, ...]:
        return self.offered

    @cached_property
    def dropped(self) -> tuple[Dropped, ...]:
        own = self._withheld
        made = self._base.dropped if self._known else ()
        told = (drop for task in sorted(own) for drop in own[task])
        return (*(drop for drop in made if drop.task_id not in own), *told)

    @cached_property
    def zones(self) -> tuple[Zone, ...]:
        return self._base.zones

    @cached_property
    def resolved(self) -> tuple[tuple[Branch, ...], bool]:
        return self._base.resolved

    @cached_property
    def finder(self) -> Routes:
        return self._base.finder

    def options_of(self, task_id: int) -> tuple[Option, ...]:
        """The options of one task."""
        return tuple(option for option in self.offered if option.task_id == task_id)


class Read(NamedTuple):
    """The inputs with what was offered, the relevant cost rows, tasks, and the number of rows ignored.

    split: options that are tasks of the assignment; inputs, rows and tasks use its ids.
    """

    inputs: Offered
    rows: list[Any]
    tasks: tuple[int, ...]
    foreign: int
    split: Split


def read(told: Told, matrix: Any, context: Context) -> Read:
    """The options and routes of a request; BadInput for what is missing or invalid."""
    request, _ = counted_once(told.request.OriginalRequest)
    # tasks that the relations do not name are not done
    tasks = tuple(task for task in request.TaskList if task in context.inputs.wanted)
    unnamed = set(request.TaskList) - set(tasks)
    missing = [task for task in tasks if task not in told.options]
    if missing:
        raise BadInput(
            "a matrix came before all options",
            item="AssignmentCostMatrix",
            expected="TaskPlanOptions of task " + ", ".join(map(str, missing)),
        )
    options = [option for task in tasks for option in _options(told.options[task], context)]
    terms = {task: composition(told.options[task]) for task in tasks}
    composed = {task: term for task, term in terms.items() if term and not is_choice(term)}
    rows = [row for row in matrix.CostMatrix if row.VehicleID in context.vehicles]
    foreign = len(matrix.CostMatrix) - len(rows)
    rows = [r for r in rows if not {r.IntialTaskID, r.DestinationTaskID} & unnamed]
    known = {(0, 0), *((o.task_id, o.option_id) for o in options)}
    for k, row in enumerate(rows):
        start = row.IntialTaskID, row.IntialTaskOption
        to = row.DestinationTaskID, row.DestinationTaskOption
        if start not in known or to not in known or to == (0, 0) or row.TimeToGo < 0:
            raise BadInput(
                "no such route between options",
                item=f"AssignmentCostMatrix.CostMatrix[{k}]",
                expected="options that the tasks have offered, and no time below 0",
                got=f"vehicle {row.VehicleID}, {start} to {to} in {row.TimeToGo} ms",
            )
    parts = split(context.inputs, composed)
    if composed:
        ids = parts.ids
        options = [
            replace(o, task_id=ids.get((o.task_id, o.option_id), o.task_id)) for o in options
        ]
        rows = [_renamed(row, ids) for row in rows]
        tasks = (*(t for t in tasks if t not in composed), *ids.values())
    inputs = Offered(parts.inputs, tuple(options), bool(context.offered), context.withheld)
    return Read(inputs, rows, tasks, foreign, parts)


def _renamed(row: Any, ids: Mapping[Pair, int]) -> Any:
    """A cost row in the ids of options that are tasks."""
    start, to = row.IntialTaskID, row.DestinationTaskID
    return row.copy(
        IntialTaskID=ids.get((start, row.IntialTaskOption), start),
        DestinationTaskID=ids.get((to, row.DestinationTaskOption), to),
    )


def _options(told: Any, context: Context) -> list[Option]:
    """TaskPlanOptions as options; BadInput for an invalid one."""
    item = f"TaskPlanOptions of task {told.TaskID}"
    mission, made = context.inputs.mission, []
    flyers = {vehicle.id: flyer_of(vehicle) for vehicle in mission.vehicles}
    ours = {
        (o.task_id, o.option_id): o
        for o in (context.inputs.options_of(told.TaskID) if told.TaskID in context.offered else ())
    }
    for k, option in enumerate(told.Options):
        where = f"{item}.Options[{k}]"
        able = [v for v in option.EligibleEntities or flyers if v in flyers]
        if not able:
            continue
        places = context.places
        start = places.pose(option.StartLocation, option.StartHeading, where, "StartLocation")
        end = places.pose(option.EndLocation, option.EndHeading, where, "EndLocation")
        if option.TaskID != told.TaskID or option.Cost < 0:
            raise BadInput(
                "not a valid task option",
                where=where,
                expected=f"TaskID {told.TaskID} and a Cost of 0 ms or more",
                got=f"TaskID {option.TaskID}, Cost {option.Cost}",
            )
        flyer, known = flyers[able[0]], ours.get((told.TaskID, option.OptionID))
        same = known and (known.start, known.end, known.duration_ms, known.flyer)
        if known is not None and same == (start, end, option.Cost, flyer):
            made.append(replace(known, vehicles=tuple(able)))
            continue
        if start.alt_m == 0:  # no altitude given: that of the vehicles
            start = start._replace(alt_m=flyer.alt_m)
        rooms = hold_rooms(start, flyer.radius_m, context.inputs.zones)
        label = f"option {option.OptionID}"
        ids = told.TaskID, option.OptionID, tuple(able)
        made.append(Option(*ids, flyer, start, end, (), option.Cost, rooms, label))
    return made


def travel_of(inputs: Inputs, rows: Iterable[Any]) -> Travel:
    """The routes of an AssignmentCostMatrix by indices of vehicles and options."""
    times: dict[tuple[int, int, int], int] = {}
    for row in rows:
        before = (row.IntialTaskID, row.IntialTaskOption)
        times[
            inputs.vehicle_index[row.VehicleID],
            START if before == (0, 0) else inputs.index[before],
            inputs.index[row.DestinationTaskID, row.DestinationTaskOption],
        ] = row.TimeToGo

    def travel_ms(vehicle: int, before: int, to: int) -> int | None:
        return times.get((vehicle, before, to))

    return travel_ms
