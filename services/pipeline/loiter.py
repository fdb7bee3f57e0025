"""LoiterAssignmentService: loiters for vehicles that would begin a task too early.

TaskAssignmentSummary gives the assignment; relations and timings give the times. The loiters in between are
those of `services.planning.loiters`, from proved kernels, whoever made the assignment: a start that it states
(TimeThreshold) is kept; where it states none, order and timing are enforced all the same. An assignment
without feasible times ends its request with the conflicting constraint.

When the plan is published, its own loiters are compared. For those that it lacks, the vehicle is sent a
VehicleActionCommand with a LoiterAction at its arrival, and one to go to the task's first waypoint after the
wait. A new plan for a vehicle voids its pending commands; plans that are not flown (`SandBoxRequest`) have no
effect. Times count from the plan, in the bus's time [ms].
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.assignment.steps import chain_holds
from cratous.services.bus import Envelope, Wake
from cratous.services.pipeline.contexts import UNIQUE, Context, Contexts
from cratous.services.pipeline.implementation import loiter_action
from cratous.services.pipeline.offers import OPTIONS, Told, read, travel_of
from cratous.services.pipeline.request_end import ENDINGS, RESPONSE, newest, request_ended
from cratous.services.pipeline.status import status
from cratous.services.planning.loiters import Given, Loiter, loiters_of, schedule
from cratous.services.planning.partial import part_problem
from cratous.spec.errors import BadInput, CratousError

NAME = "LoiterAssignmentService"
MATRIX = "uxas.messages.task.AssignmentCostMatrix"
SUMMARY = "uxas.messages.task.TaskAssignmentSummary"
COMMANDS_FROM = 2**40
"""Ids of its commands start here, apart from those of plans."""


class Due(NamedTuple):
    """A loiter, and the action that commands it."""

    loiter: Loiter
    action: Any


class Work(NamedTuple):
    """State of one request: its messages, its costs, and its loiters once it is assigned."""

    told: Told
    matrix: Any = None
    due: tuple[Due, ...] = ()


class Order(NamedTuple):
    """A loiter still to be commanded, and the waypoint to go to after it."""

    due: Due
    waypoint: int


class Loiters(NamedTuple):
    """Requests in progress; pending orders by number; numbers of orders and commands issued."""

    work: dict[int, Work]
    orders: dict[int, Order]
    numbers: int = 0
    commands: int = 0


Result = tuple[Loiters, Iterable[Any]]


class LoiterAssignmentService:
    """TaskAssignmentSummary, UniqueAutomationResponse -> VehicleActionCommand at their times."""

    name = NAME
    subscribes: tuple[str, ...] = (UNIQUE, OPTIONS, MATRIX, SUMMARY, *ENDINGS)

    def __init__(self, contexts: Contexts) -> None:
        self._contexts = contexts

    def start(self) -> Loiters:
        return Loiters({}, {})

    def handle(self, state: Loiters, envelope: Envelope, now_ms: int) -> Result:
        body, topic = envelope.body, envelope.topic
        if topic == UNIQUE:
            work = {**state.work, body.RequestID: Work(Told(body, {}))}
            return state._replace(work=newest(work)), ()
        if topic in ENDINGS:
            ended = request_ended(topic, body)
            mine = state.work.get(ended)
            state = state._replace(work={k: v for k, v in state.work.items() if k != ended})
            if topic != RESPONSE or mine is None or mine.told.request.SandBoxRequest:
                return state, ()
            return self._planned(state, mine, body)
        key = body.CorrespondingAutomationRequestID
        mine = state.work.get(key)
        if mine is None:
            return state, ()
        if topic == OPTIONS:
            known = {body.TaskID: body, **mine.told.options}
            mine = mine._replace(told=mine.told._replace(options=known))
        elif topic == MATRIX:
            mine = mine._replace(matrix=mine.matrix or body)
        else:
            return self._assigned(state, key, mine, body)
        return state._replace(work={**state.work, key: mine}), ()

    def _assigned(self, state: Loiters, key: int, mine: Work, summary: Any) -> Result:
        """Compute the loiters of an assignment; an error ends its request."""
        try:
            due = _due(self._contexts.of(key), mine, summary)
        except CratousError as error:
            left = {k: v for k, v in state.work.items() if k != key}
            return state._replace(work=left), [self._contexts.fail(key, error)]
        facts = [("loiter", _text(one.loiter)) for one in due]
        work = {**state.work, key: mine._replace(due=due)}
        return state._replace(work=work), [status(key, "Information", facts)] if facts else ()

    def _planned(self, state: Loiters, mine: Work, response: Any) -> Result:
        """A plan is published: pending orders of its vehicles are void, its missing loiters are scheduled."""
        commands = {c.VehicleID: c for c in response.OriginalResponse.MissionCommandList}
        orders = {
            k: order for k, order in state.orders.items()
            if order.due.loiter.vehicle_id not in commands
        }  # fmt: skip
        number, out = state.numbers, []
        for due in mine.due:
            loiter = due.loiter
            command = commands.get(loiter.vehicle_id)
            points = [
                point for point in (command.WaypointList if command is not None else ())
                if loiter.task_id in point.AssociatedTasks
            ]  # fmt: skip
            held = sum(_held(point, loiter.task_id) for point in points)
            # checked as a task of its own: from the arrival to the start of the task
            as_leg = (loiter.arrive_ms, loiter.arrive_ms, loiter.start_ms, held)
            if points and chain_holds([as_leg]):
                continue
            if not points or held:
                why = f"the plan waits {held / 1000:.3f} s" if points else "the plan lacks the task"
                text = f"{_text(loiter)}, but {why}"
                out.append(status(response.ResponseID, "Error", [("reason", text)]))
                continue
            number += 1
            orders[number] = Order(due, points[0].Number)
            out.append(Wake(loiter.arrive_ms, number))
        return state._replace(orders=orders, numbers=number), out

    def wake(self, state: Loiters, key: int, now_ms: int) -> Result:
        """A vehicle arrives (positive order number) or its wait is over (negative)."""
        order = state.orders.get(abs(key))
        if order is None:
            return state, ()
        due, count, out = order.due, state.commands + 1, []
        action = due.action
        if key < 0:
            action = lmcp.new("GoToWaypointAction", WaypointNumber=order.waypoint)
        command = lmcp.new(
            "VehicleActionCommand",
            CommandID=COMMANDS_FROM + count,
            VehicleID=due.loiter.vehicle_id,
            VehicleActionList=[action],
        )
        out = [command, Wake(due.loiter.wait_ms, -key)] if key > 0 else [command]
        orders = {k: v for k, v in state.orders.items() if k != -key}
        return state._replace(commands=count, orders=orders), out


def _due(context: Context, mine: Work, summary: Any) -> tuple[Due, ...]:
    """The loiters of an assignment, with their actions."""
    if mine.matrix is None:
        raise BadInput(
            "an assignment came before its costs",
            item="TaskAssignmentSummary",
            expected=f"an AssignmentCostMatrix of request {mine.told.request.RequestID} before it",
        )
    offered = read(mine.told, mine.matrix, context)
    problem = offered.inputs.problem(travel_of(offered.inputs, offered.rows))
    ids = offered.split.ids
    given = [
        Given(
            task.AssignedVehicle,
            ids.get((task.TaskID, task.OptionID), task.TaskID),
            task.OptionID,
            task.TimeThreshold,
        )
        for task in summary.TaskList
    ]
    steps = schedule(part_problem(problem, {one.task_id for one in given}), given)
    loiters = loiters_of(steps, offered.inputs.options, context.inputs.zones)
    for loiter in loiters:
        if loiter.task_id in offered.split.pairs:
            # waypoints name tasks only: they cannot tell several options of a task apart
            raise BadInput(
                "a wait before one of several options of a task is not covered here",
                item="TaskAssignmentSummary",
                expected="a plan that waits by itself, without the LoiterAssignmentService",
                got=offered.split.told(_text(loiter)),
            )
    return tuple(Due(loiter, _action(context, loiter)) for loiter in loiters)


def _action(context: Context, one: Loiter) -> Any:
    return loiter_action(context.places, one.task_id, one.hold, one.wait_ms, one.speed_m_s)


def _held(point: Any, task: int) -> int:
    """Time that a plan has a vehicle loiter at a waypoint before a task [ms]."""
    return sum(
        action.Duration
        for action in point.VehicleActionList
        if action.type_name == "CMASI/LoiterAction" and task in action.AssociatedTaskList
    )


def _text(loiter: Loiter) -> str:
    return (
        f"vehicle {loiter.vehicle_id} waits {loiter.wait_ms / 1000:.3f} s before task "
        f"{loiter.task_id}, from {loiter.arrive_ms / 1000:.3f} s"
    )
