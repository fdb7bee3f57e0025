"""AssignmentTreeBranchBoundService on messages: options and costs -> who does what, or why nobody.

Options, their costs and who may fly them come from TaskPlanOptions, the ways from the
AssignmentCostMatrix; vehicles that the request does not name take no part, whatever rows there are.
The search is that of `services.planning`.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import Any, NamedTuple

from cratous.services.bus import Envelope
from cratous.services.frames import compass
from cratous.services.planning.assignment_service import (
    AssignmentTreeBranchBoundService as Search,
)
from cratous.services.planning.desk import Inputs, status
from cratous.services.planning.flyers import Flyer, flyer_of
from cratous.services.planning.options import Dropped, Option, hold_rooms
from cratous.services.uxas.pipeline.contexts import UNIQUE, Context, Contexts, reasons_of
from cratous.services.uxas.pipeline.ended import ENDINGS, newest, request_ended
from cratous.spec import algebra
from cratous.spec.errors import BadInput, CratousError
from cratous.spec.plan import Pose

NAME = "AssignmentTreeBranchBoundService"
OPTIONS = "uxas.messages.task.TaskPlanOptions"


class Told(NamedTuple):
    """Of one request: the request, and options by task."""

    request: Any
    options: dict[int, Any]


class Offered(Inputs):
    """Inputs whose options are those that the tasks have offered in messages."""

    offered: tuple[Option, ...] = ()
    not_offered: tuple[Dropped, ...] = ()

    @cached_property
    def options(self) -> tuple[Option, ...]:
        return self.offered

    @cached_property
    def dropped(self) -> tuple[Dropped, ...]:
        return self.not_offered

    def options_of(self, task_id: int) -> tuple[Option, ...]:
        """The options of one task."""
        return tuple(option for option in self.offered if option.task_id == task_id)


class _Desk:
    """What the search asks for: the inputs of the one request that it is asked about."""

    def __init__(self) -> None:
        self.found: Inputs | None = None

    def inputs(self, request_id: int) -> Inputs:
        """The inputs of the request in work."""
        assert self.found is not None
        return self.found


class AssignmentTreeBranchBoundService:
    """UniqueAutomationRequest, TaskPlanOptions, AssignmentCostMatrix -> TaskAssignmentSummary."""

    name = NAME
    subscribes: tuple[str, ...] = (
        UNIQUE,
        OPTIONS,
        "uxas.messages.task.AssignmentCostMatrix",
        *ENDINGS,
    )

    def __init__(self, contexts: Contexts) -> None:
        self._contexts, self._desk = contexts, _Desk()
        self._search = Search(self._desk)  # type: ignore[arg-type]

    def start(self) -> dict[int, Told]:
        return {}

    def handle(
        self, state: dict[int, Told], envelope: Envelope, now_ms: int
    ) -> tuple[dict[int, Told], Iterable[Any]]:
        body, topic = envelope.body, envelope.topic
        if topic == UNIQUE:
            return newest({**state, body.RequestID: Told(body, {})}), ()
        if topic in ENDINGS:
            ended = request_ended(topic, body)
            return {k: v for k, v in state.items() if k != ended}, ()
        key = body.CorrespondingAutomationRequestID
        mine = state.get(key)
        if mine is None:
            return state, ()
        if topic == OPTIONS:
            if body.TaskID in mine.options:
                return state, ()
            told = mine._replace(options={**mine.options, body.TaskID: body})
            return {**state, key: told}, ()
        left = {k: v for k, v in state.items() if k != key}
        try:
            return left, self._assign(mine, envelope, now_ms)
        except CratousError as error:
            return left, [status(key, "Error", [("reason", text) for text in reasons_of(error)])]

    def _assign(self, mine: Told, envelope: Envelope, now_ms: int) -> list[Any]:
        context = self._contexts.of(mine.request.RequestID)
        matrix, out = envelope.body, []
        request = mine.request.OriginalRequest
        # tasks that the relations do not name are not done, whoever has asked for them
        tasks = [task for task in request.TaskList if task in context.inputs.wanted]
        unnamed = set(request.TaskList) - set(tasks)
        missing = [task for task in tasks if task not in mine.options]
        if missing:
            raise BadInput(
                "a matrix came before all options",
                item="AssignmentCostMatrix",
                expected="TaskPlanOptions of task " + ", ".join(map(str, missing)),
            )
        inputs = Offered(context.inputs.mission, context.inputs.starts, (), 0)
        inputs.offered = tuple(
            option for task in tasks for option in _options(mine.options[task], context)
        )
        if context.offered:
            inputs.not_offered = context.inputs.dropped
        rows = [row for row in matrix.CostMatrix if row.VehicleID in context.vehicles]
        foreign = len(matrix.CostMatrix) - len(rows)
        if foreign:
            text = (
                f"{foreign} rows are of vehicles that the request does not name: they take no part"
            )
            out.append(status(mine.request.RequestID, "Warning", [("reason", text)]))
        rows = [r for r in rows if not {r.IntialTaskID, r.DestinationTaskID} & unnamed]
        known = {(0, 0), *((o.task_id, o.option_id) for o in inputs.offered)}
        for k, row in enumerate(rows):
            start = row.IntialTaskID, row.IntialTaskOption
            to = row.DestinationTaskID, row.DestinationTaskOption
            if start not in known or to not in known or to == (0, 0) or row.TimeToGo < 0:
                raise BadInput(
                    "no such way between options",
                    item=f"AssignmentCostMatrix.CostMatrix[{k}]",
                    expected="options that the tasks have offered, and no time below 0",
                    got=f"vehicle {row.VehicleID}, {start} to {to} in {row.TimeToGo} ms",
                )
        self._desk.found = inputs
        asked = matrix.copy(CostMatrix=rows)
        body = Envelope(envelope.seq, envelope.time_ms, envelope.source, envelope.topic, asked)
        _, found = self._search.handle(self._search.start(), body, now_ms)
        reached = {row.DestinationTaskID for row in rows}
        why = [f"the costs have no way to task {task}" for task in tasks if task not in reached]
        return [*out, *(_explained(body, why) for body in found)]


def _explained(body: Any, why: list[str]) -> Any:
    """An error with what the messages show besides the search's own reasons."""
    if type(body).__name__ != "ServiceStatus" or body.StatusType.name != "Error" or not why:
        return body
    more = status(0, "Error", [("reason", text) for text in why]).Info[1:]
    return body.copy(Info=[*body.Info, *more])


def _options(told: Any, context: Context) -> list[Option]:
    """TaskPlanOptions as options; BadInput for a composition that names what is not offered."""
    item = f"TaskPlanOptions of task {told.TaskID}"
    _check_composition(told, item)
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
        start = context.desk.pose(option.StartLocation, option.StartHeading, where, "StartLocation")
        end = context.desk.pose(option.EndLocation, option.EndHeading, where, "EndLocation")
        if option.TaskID != told.TaskID or option.Cost < 0:
            raise BadInput(
                "an option that is none",
                where=where,
                expected=f"TaskID {told.TaskID} and a Cost of 0 ms or more",
                got=f"TaskID {option.TaskID}, Cost {option.Cost}",
            )
        if start.alt_m == 0:  # it says nothing of the altitude: that of the vehicles
            start = start._replace(alt_m=flyers[able[0]].alt_m)
        flyer, known = flyers[able[0]], ours.get((told.TaskID, option.OptionID))
        if known is not None and _same_start(known, flyer, start, option.StartHeading):
            rooms = known.holds
        else:
            rooms = hold_rooms(start, flyer.radius_m, context.inputs.zones)
        label = f"option {option.OptionID}"
        ids = told.TaskID, option.OptionID, tuple(able)
        made.append(Option(*ids, flyer, start, end, (), option.Cost, rooms, label))
    return made


def _same_start(known: Option, flyer: Flyer, start: Pose, heading_deg: float) -> bool:
    """True if an option computed here starts there, so that its room to hold is known."""
    there = (*known.start[:3], compass(known.start.heading_rad), known.flyer)
    asked = (*start[:3], heading_deg, flyer)
    return there == asked


def _is_choice(term: algebra.Term) -> bool:
    """True if a term is one of its atoms, whatever the nesting of the choices."""
    if isinstance(term, algebra.Atom):
        return True
    return term.op == algebra.ALTERNATIVE and all(_is_choice(part) for part in term.operands)


def _check_composition(told: Any, item: str) -> None:
    """A composition has to be a choice of exactly the options that are offered."""
    listed = {option.OptionID for option in told.Options}
    if not told.Composition.strip() and not listed:
        return
    term = algebra.parse(told.Composition, where=item)
    flat = _is_choice(term)
    named = {atom.task for atom in algebra.atoms(term)}
    if flat and named == listed:
        return
    what = "compositions other than a choice of one option are not covered"
    if flat:
        what = "this is no choice of the options that are offered"
    expected = "+(" + " ".join(f"p{n}" for n in sorted(listed)) + ")"
    raise BadInput(what, where=item, item="Composition", expected=expected, got=told.Composition)
