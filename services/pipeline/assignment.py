"""AssignmentTreeBranchBoundService: an assignment from options and costs, or the reasons why none exists.

Options, their costs and eligible vehicles come from TaskPlanOptions, the routes from the
AssignmentCostMatrix; rows of vehicles that the request does not name are ignored. The search is that of
`services.planning.mission_assign`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from cratous.bridge import lmcp
from cratous.core.assignment.problem import Assignment
from cratous.services.bus import Envelope
from cratous.services.pipeline.compositions import Pair
from cratous.services.pipeline.contexts import UNIQUE, Contexts
from cratous.services.pipeline.offers import OPTIONS, Read, Told, read, travel_of
from cratous.services.pipeline.request_end import ENDINGS, newest, request_ended
from cratous.services.pipeline.status import status
from cratous.services.planning import mission_assign, without_vehicles
from cratous.services.planning.assign_problem import not_all_of
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.omitted_tasks import NothingDone, assign_part
from cratous.services.planning.options import Option
from cratous.services.planning.partial import Parts
from cratous.services.planning.remedies import remedies_of
from cratous.spec.errors import BadInput, CratousError, NoPlan
from cratous.spec.mission.plan import COST_UNITS

NAME = "AssignmentTreeBranchBoundService"


class AssignmentTreeBranchBoundService:
    """UniqueAutomationRequest, TaskPlanOptions, AssignmentCostMatrix -> TaskAssignmentSummary.

    In the summary TimeThreshold is the start of the task, so that a later departure becomes a wait;
    TimeTaskCompleted is its end (ms after mission start).
    """

    name = NAME
    subscribes: tuple[str, ...] = (
        UNIQUE,
        OPTIONS,
        "uxas.messages.task.AssignmentCostMatrix",
        *ENDINGS,
    )

    def __init__(self, contexts: Contexts) -> None:
        self._contexts = contexts

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
        out: list[Any] = []
        try:
            self._assign(mine, body, out)
        except CratousError as error:
            out.append(self._contexts.fail(key, error))
        return left, out

    def _assign(self, mine: Told, matrix: Any, out: list[Any]) -> None:
        """Publish the summary of an assignment; NoPlan or BadInput with the reasons if there is none."""
        key = mine.request.RequestID
        context = self._contexts.of(key)
        offered = read(mine, matrix, context)
        if offered.foreign:
            text = f"{offered.foreign} rows are of vehicles that the request does not name: they take no part"
            out.append(status(key, "Warning", [("reason", text)]))
        context.assigned = _found(offered)
        result = context.assigned.assignment
        assert result is not None
        inputs, pairs = offered.inputs, offered.split.pairs
        listed = [
            lmcp.new(
                "TaskAssignment",
                TaskID=_task(inputs.options[placed.candidate].task_id, pairs),
                OptionID=inputs.options[placed.candidate].option_id,
                AssignedVehicle=inputs.mission.vehicles[placed.vehicle].id,
                TimeThreshold=placed.start_ms,
                TimeTaskCompleted=placed.end_ms,
            )
            for placed in result.placed
        ]
        summary = lmcp.new(
            "TaskAssignmentSummary",
            CorrespondingAutomationRequestID=key,
            OperatingRegion=matrix.OperatingRegion,
            TaskList=listed,
        )
        out += [
            status(key, "Information", facts(result, inputs.mission.cost)),
            *_not_all(key, inputs),
            *_left_out(key, context.assigned),
            *_in_part(key, inputs.options, result),
            summary,
        ]


def _task(number: int, pairs: Mapping[int, Pair]) -> int:
    """The request's task for a task of the assignment."""
    return pairs[number][0] if number in pairs else number


def _found(offered: Read) -> mission_assign.Found:
    """The assignment of all tasks, else of the part that leaves out least; NoPlan if nothing can be done,
    with the tasks that no vehicle can do or reach, or the conflicting constraints.

    Where options are tasks of their own, a partial assignment might split a task: then it is all or nothing.
    """
    inputs, rows, tasks = offered.inputs, offered.rows, offered.tasks
    mission, problem = inputs.mission, inputs.problem(travel_of(inputs, rows))
    limits = mission_assign.limits_of(mission)
    try:
        # for a mission, the partial assignment explains why the rest cannot be done
        found = mission_assign.assign(problem, limits, tell=bool(offered.split.ids))
    except BadInput as error:
        # an error already explained per task is no input error
        why = without_vehicles.why_none(inputs) or tuple(inputs.undone.values())
        if not why:
            raise
        if not problem.choices:
            raise NothingDone(why, without_vehicles.unable(inputs)) from error
        found = mission_assign.Found(None, None, why)
    if found.assignment is None and offered.split.ids:
        reached = {row.DestinationTaskID for row in rows}
        missing = [f"the costs have no way to task {task}" for task in tasks if task not in reached]
        why = (*missing, *found.reasons) or without_vehicles.why_none(inputs)
        raise NoPlan(tuple(offered.split.told(text) for text in why))
    if found.assignment is None:
        priority = {task.id: task.priority for task in mission.tasks}
        part = assign_part(
            problem, limits, Parts(problem, priority, inputs.begun),
            without_vehicles.unable(inputs), lambda task: remedies_of(inputs, task),
        )  # fmt: skip
        if part.assignment is not None:
            return part
        unreached = [t for t in tasks if t not in {row.DestinationTaskID for row in rows}]
        why = _nothing(inputs, part, unreached) or found.reasons
        of = {one.task_id: one.reason for one in part.left_out}
        raise NothingDone(why or mission_assign.assign(problem, limits).reasons, of)
    return found


def _nothing(
    inputs: Inputs, part: mission_assign.Found, unreached: Sequence[int]
) -> tuple[str, ...]:
    """Why each requested task cannot be done, if none can. unreached: tasks to which the costs have no route."""
    no_options, no_routes = without_vehicles.without_options, without_vehicles.without_routes
    named = no_options(inputs).keys() | no_routes(inputs).keys()
    others = [one.text for one in part.left_out if one.task_id not in named]
    others += [f"the costs have no way to task {task}" for task in unreached if task not in named]
    doubt = () if part.sure else ("whether some of it could be done is not certain",)
    return (*without_vehicles.why_none(inputs), *others, *doubt)


def _not_all(key: int, inputs: Inputs) -> list[Any]:
    """A warning where not all alternatives were examined."""
    cut = not_all_of(inputs.term)
    text = f"{cut}: there may be a better plan"
    return [status(key, "Warning", [("reason", text)])] if cut else []


def _left_out(key: int, found: mission_assign.Found) -> list[Any]:
    """A warning for each task that is left out, with its TaskID and the reason."""
    return [
        status(key, "Warning", [("TaskID", str(left.task_id)), ("reason", left.text)])
        for left in found.left_out
    ]


def _in_part(key: int, options: Sequence[Option], result: Assignment) -> list[Any]:
    """A warning for each task that is done in part, with its TaskID, its share, and the zones."""
    return [
        status(
            key,
            "Warning",
            [
                ("TaskID", str(part.task_id)),
                ("share", f"{part.share:.4f}"),
                ("zones", " ".join(map(str, part.zones))),
                ("reason", part.text),
            ],
        )
        for part in mission_assign.parts_in(options, result)
    ]


def facts(result: Assignment, cost: str) -> list[tuple[str, str]]:
    """Facts about an assignment, for a status. Its status is `optimal` only with a certificate."""
    return [
        (f"cost_{COST_UNITS[cost].lower()}", str(result.cost)),
        ("status", result.status),
        ("bound", str(result.bound) if result.bound > 0 else "unknown"),
        ("gap", f"{result.gap:.6f}" if result.bound > 0 else "unknown"),
        ("nodes", str(result.nodes)),
        ("certificate", result.digest),
    ]
