"""The planning pipeline as it runs under `cratous uxas`: requests come at any time, tasks come and go.

A request is understood with what the messages have told until then: it becomes a mission, by the
loader that also reads UxAS folders, and the services of `services.planning` plan it. One request
is in the pipeline at a time, the others wait their turn; every request gets one AutomationResponse,
which bears the reasons in `Info` where there is no plan. The services share a desk in memory, so
they live in one process together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Envelope, Wake
from cratous.services.frames import Projection
from cratous.services.loading.uxas import mission_of
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.planning import stages
from cratous.services.planning.assignment_service import AssignmentTreeBranchBoundService
from cratous.services.planning.builder import PlanBuilderService
from cratous.services.planning.desk import Desk, Inputs, status
from cratous.services.planning.route_services import (
    RouteAggregatorService,
    RoutePlannerVisibilityService,
)
from cratous.services.planning.task_service import NAMES, TaskService
from cratous.services.planning.validator import planning_states
from cratous.services.uxas.frame import Host
from cratous.services.uxas.world import World
from cratous.spec.errors import BadInput, CratousError, NoPlan
from cratous.spec.mission import Mission, Task, TaskKind

INITIALIZED = "uxas.messages.task.TaskInitialized"
TASKS = {
    "afrl.cmasi.LineSearchTask": TaskKind.LINE_SEARCH,
    "afrl.cmasi.PointSearchTask": TaskKind.POINT_SEARCH,
    "afrl.cmasi.MustFlyTask": TaskKind.MUST_FLY,
    "afrl.cmasi.LoiterTask": TaskKind.LOITER,
}
_INFO = 8  # entries of AutomationResponse.Info


class LiveDesk(Desk):
    """A desk whose mission is that of the request in work."""

    def __init__(self, world: World) -> None:
        self.world = world
        self._open: dict[int, Inputs] = {}
        self.requests: list[Inputs] = []  # of the base; here only those in work are kept
        self.count = 0

    def open(self, inputs: Inputs) -> int:
        """Put a request on the desk; its id, from 1."""
        self.mission: Mission = inputs.mission
        self.projection = Projection(inputs.mission.frame)
        self.count += 1
        self._open[self.count] = inputs
        return self.count

    def inputs(self, request_id: int) -> Inputs:
        """The request with this id; BadInput if it is not in work."""
        found = self._open.get(request_id)
        if found is None:
            raise BadInput(
                "no such request is being planned here",
                item="RequestID",
                expected=", ".join(map(str, self._open)) or "none is",
                got=str(request_id),
            )
        return found

    def has(self, request_id: int) -> bool:
        """True if this request is in work."""
        return request_id in self._open

    @property
    def in_work(self) -> tuple[int, ...]:
        """The ids of the requests in work."""
        return tuple(self._open)

    def close(self, request_id: int) -> None:
        """The request is done with."""
        self._open.pop(request_id, None)


class Line(NamedTuple):
    """Requests that wait, each with its number on the bus, and the id of the one in work (0: none)."""

    waiting: tuple[tuple[Any, int], ...] = ()
    work: int = 0


class LiveValidator:
    """AutomationRequest -> UniqueAutomationRequest, one at a time -> AutomationResponse.

    Requests of other kinds (ImpactAutomationRequest, TaskAutomationRequest) are answered with an
    error status: they are not covered yet.
    """

    name = "AutomationRequestValidatorService"
    subscribes: tuple[str, ...] = (
        "afrl.cmasi.AutomationRequest",
        "afrl.impact.ImpactAutomationRequest",
        "uxas.messages.task.TaskAutomationRequest",
        "uxas.messages.task.UniqueAutomationResponse",
        "afrl.cmasi.ServiceStatus",
    )

    def __init__(self, host: Host, desk: LiveDesk, limit_ms: int, services: Any) -> None:
        """services: (type, attributes, line) of the configuration, for what it says of planning."""
        self._host, self._desk, self._limit_ms = host, desk, limit_ms
        self._services = services

    def start(self) -> Line:
        return Line()

    def handle(self, state: Line, envelope: Envelope, now_ms: int) -> tuple[Line, Iterable[Any]]:
        body, topic = envelope.body, envelope.topic
        if topic == "uxas.messages.task.UniqueAutomationResponse":
            if body.ResponseID != state.work:
                return state, ()
            return self._next(state, [body.OriginalResponse], now_ms)
        if topic == "afrl.cmasi.ServiceStatus":
            facts = {pair.Key: pair.Value for pair in body.Info}
            ours = facts.get("RequestID") == str(state.work) and state.work
            if not ours or body.StatusType.name != "Error":
                return state, ()
            reasons = [pair.Value for pair in body.Info if pair.Key == "reason"]
            return self._next(state, [_no_plan(reasons)], now_ms)
        if topic != "afrl.cmasi.AutomationRequest":
            kind = topic.rpartition(".")[2]
            reason = f"{kind} is not covered yet; send an AutomationRequest"
            return state, [status(0, "Error", [("reason", reason)])]
        state = state._replace(waiting=(*state.waiting, (body, envelope.seq)))
        if state.work:
            return state, ()
        return self._next(state, [], now_ms)

    def wake(self, state: Line, key: int, now_ms: int) -> tuple[Line, Iterable[Any]]:
        """The response to request `key` is late."""
        if key != state.work:
            return state, ()
        reason = f"no response within MaxResponseTime_ms = {self._limit_ms}"
        out = [status(key, "Error", [("reason", reason)]), _no_plan([reason])]
        return self._next(state, out, now_ms)

    def _next(self, state: Line, out: list[Any], now_ms: int) -> tuple[Line, list[Any]]:
        """Close what is in work and take up the next request that can be."""
        if state.work:
            self._desk.close(state.work)
        state = state._replace(work=0)
        while state.waiting and not state.work:
            (request, seq), *rest = state.waiting
            state = state._replace(waiting=tuple(rest))
            try:
                inputs, made = self._inputs(request, seq)
            except CratousError as error:
                reasons = _reasons(error)
                number = self._desk.count + 1
                out += [
                    status(number, "Error", [("reason", text) for text in reasons]),
                    _no_plan(reasons),
                ]
                self._desk.count = number
                continue
            number = self._desk.open(inputs)
            unique = lmcp.new(
                "UniqueAutomationRequest",
                RequestID=number,
                OriginalRequest=made,
                PlanningStates=planning_states(self._desk, inputs, made.EntityList),
            )
            out += [unique, Wake(self._limit_ms, number)]
            state = state._replace(work=number)
        return state, out

    def _inputs(self, request: Any, seq: int) -> tuple[Inputs, Any]:
        """The request as a mission with its starts; CratousError says why it cannot be planned."""
        sent = Sent(request, f"AutomationRequest (message {seq})", 0)
        root = {k: str(v) for k, v in self._host.root.items() if v}
        cfg = self._desk.world.configuration(self._host.config, root, self._services, sent)
        mission = mission_of(cfg, str(self._host.config))
        for note in mission.notes:
            self._host.log("INFO", f"request {self._desk.count + 1}: {note}")
        poses = stages.start_poses(mission)
        inputs = Inputs(mission, poses, (), 0)
        stages.check_starts(mission, poses, inputs.zones)
        if not inputs.wanted:
            raise NoPlan(("no branch of the relations has a task",))
        made = request.copy(
            EntityList=[vehicle.id for vehicle in mission.vehicles], TaskList=list(inputs.wanted)
        )
        return inputs, made


def _reasons(error: CratousError) -> list[str]:
    if isinstance(error, NoPlan):
        return list(error.reasons)
    problems = getattr(error, "problems", (error,))
    return [str(problem) for problem in problems]


def _no_plan(reasons: Iterable[str]) -> Any:
    """An AutomationResponse without commands that says why."""
    pairs = [lmcp.new("KeyValuePair", Key="reason", Value=text) for text in reasons]
    return lmcp.new("AutomationResponse", Info=pairs[:_INFO])


class LiveTask(TaskService):
    """A task's service as TaskManagerService has it made; it lives until it is killed."""

    def __init__(self, desk: LiveDesk, task: Any, kind: TaskKind) -> None:
        """task: the LMCP task that it serves."""
        self._desk: LiveDesk = desk
        self._body = task
        self._task_id = task_id = task.TaskID
        self.name = f"{NAMES[kind]}[{task_id}]"

    @property
    def _task(self) -> Task:  # type: ignore[override]
        for task in self._desk.mission.tasks if self._desk.in_work else ():
            if task.id == self._task_id:
                return task
        raise BadInput(
            "no request with this task is being planned here",
            item="TaskID",
            expected="a request of this process' AutomationRequestValidatorService",
            got=str(self._task_id),
        )

    def begin(self, state: Any) -> tuple[Any, Iterable[Any]]:
        """Say that the task is there."""
        return state, [lmcp.new("TaskInitialized", TaskID=self._task_id)]

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        body = envelope.body
        if envelope.topic == "uxas.messages.task.UniqueAutomationRequest":
            if self._task_id not in body.OriginalRequest.TaskList:
                return state, ()
        elif getattr(body, "TaskID", self._task_id) != self._task_id:
            return state, ()
        if getattr(body, "AssociatedTaskID", self._task_id) != self._task_id:
            return state, ()
        return super().handle(state, envelope, now_ms)

    def stop(self, state: Any) -> None:
        """The task is no more, unless another has taken its place already."""
        known = self._desk.world.task(self._task_id)
        if known is not None and known.body == self._body:
            self._desk.world.forget("task", self._task_id)


class TaskManagerService:
    """Task -> CreateNewService with its XML; a task of a known id, or RemoveTasks -> KillService."""

    subscribes: tuple[str, ...] = ("afrl.cmasi.Task", "afrl.cmasi.RemoveTasks")

    def __init__(self, name: str, host: Host, desk: LiveDesk, new_id: Any) -> None:
        """new_id(): the next service id of this process."""
        self.name, self._host, self._desk, self._new_id = name, host, desk, new_id

    def start(self) -> dict[int, int]:
        return {}

    def handle(
        self, state: dict[int, int], envelope: Envelope, now_ms: int
    ) -> tuple[dict[int, int], Iterable[Any]]:
        body = envelope.body
        if envelope.topic == "afrl.cmasi.RemoveTasks":
            gone = [n for n in body.TaskList if n in state]
            left = {n: service for n, service in state.items() if n not in gone}
            return left, [lmcp.new("KillService", ServiceID=state[n]) for n in gone]
        out: list[Any] = []
        if body.TaskID in state:
            out.append(lmcp.new("KillService", ServiceID=state[body.TaskID]))
        number = self._new_id()
        out.append(self._create(body, envelope.topic, number))
        return {**state, body.TaskID: number}, out

    def _create(self, task: Any, full_name: str, number: int) -> Any:
        world = self._desk.world
        # the closing tag is the receiver's to add, as UxAS has it
        text = f'<Service Type="{full_name}"><TaskRequest>{lmcp.xml.dumps(task)}</TaskRequest>'
        return lmcp.new(
            "CreateNewService",
            ServiceID=number,
            XmlConfiguration=text,
            EntityConfigurations=[x.copy() for x in world.of("configuration")],
            EntityStates=[x.copy() for x in world.of("state")],
            KeepInZones=[x.copy() for x in world.of("zone") if type(x).__name__ == "KeepInZone"],
            KeepOutZones=[x.copy() for x in world.of("zone") if type(x).__name__ == "KeepOutZone"],
            OperatingRegions=[x.copy() for x in world.of("region")],
        )


class Forgetful:
    """A pipeline service that keeps nothing of a request that is done with."""

    def __init__(self, inner: Any, forget: Callable[[Any], Any]) -> None:
        self._inner, self._forget = inner, forget
        self.name: str = inner.name
        self.subscribes: tuple[str, ...] = inner.subscribes

    def start(self) -> Any:
        return self._inner.start()

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        state, bodies = self._inner.handle(state, envelope, now_ms)
        return self._forget(state), bodies


def pipeline(kind: str, desk: LiveDesk) -> Any:
    """The planning service of a UxAS name, on the live desk."""
    if kind == "AssignmentTreeBranchBoundService":
        return Forgetful(
            AssignmentTreeBranchBoundService(desk), lambda s: s._replace(found={}, failed={})
        )
    if kind == "PlanBuilderService":
        return Forgetful(PlanBuilderService(desk), lambda s: s._replace(plans={}))
    if kind == "RoutePlannerVisibilityService":
        return Forgetful(
            RoutePlannerVisibilityService(desk),
            lambda s: s._replace(last={k: v for k, v in s.last.items() if desk.has(k[0])}),
        )
    return RouteAggregatorService(desk)
