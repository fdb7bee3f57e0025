"""The service of a task that follows an entity: a task service with a separate task state per vehicle.

Requests, options and routes work as in `pipeline.tasks`. From the choice of an option on, its vehicle has a
task state of its own, driven by the same kernel `task_step`. On reaching the option's path it is commanded to
circle around the entity (VehicleActionCommand), updated with each of its states. The task is complete when
enough vehicles have done what it requires, at the same time and without a break, for the required duration,
as `kept_step` decides.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import Vec2
from cratous.core.tasks.stations import Kept, kept_step
from cratous.services.bus import Envelope
from cratous.services.following import vehicle_part as parts_of
from cratous.services.following.motion import STALE_MS, Motion, motion_of
from cratous.services.following.task_options import offered, options_of
from cratous.services.following.task_parameters import (
    TOLD_MOST,
    Asked,
    Tower,
    asked_of,
    route_named,
    tower_of,
    unused_of,
    within,
)
from cratous.services.following.vehicle_part import Part
from cratous.services.pipeline.contexts import UNIQUE, Context, Contexts
from cratous.services.pipeline.mission_end import MISSION, plan_that_ends
from cratous.services.pipeline.off_plan import HANDED_BACK, WITH_UXAS
from cratous.services.pipeline.status import status
from cratous.services.pipeline.task_state import State
from cratous.services.pipeline.tasks import (
    ACTIVE,
    CHOSEN,
    LISTED,
    PUBLISH_OPTIONS,
    REMOVE,
    UNLISTED,
    WITHDRAWN,
    TaskService,
)
from cratous.services.planning.options import Dropped, Option
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, TaskKind

CHOICE = "uxas.messages.task.TaskImplementationRequest"
ROUTES = "uxas.messages.route.RoutePlanResponse"
RESPONSE = "afrl.cmasi.AutomationResponse"
FINAL, SELECTED = 5, 6
"""Task states from the choice of an option on, as in `spec.contracts.tasks`."""
SILENT_MS = 3_000
"""A vehicle silent for longer does not count as still there [ms]."""
LOST = "the state of the entity"
"""The reported reason why a vehicle does not reach its circle if the entity's state is missing or invalid."""


class Following(NamedTuple):
    """lead: the task until options are chosen; parts: of the vehicles; still: the entity stands still, and
    the lead alone does the task; kept: how long the parts have done what is required; now_ms: of the
    newest state; plans: waypoints of the vehicles' plans by number; meeting: progress of a rendezvous,
    None for other tasks.
    """

    lead: State = State()
    still: bool = False
    parts: tuple[Part, ...] = ()
    kept: Kept = Kept(-1, False)
    now_ms: int = 0
    plans: Mapping[int, Mapping[int, Position]] = MappingProxyType({})
    meeting: Any = None

    def with_part(self, part: Part) -> Following:
        """The state with a part in place of its vehicle's previous one."""
        rest = [p for p in self.parts if p.option.vehicles != part.option.vehicles]
        return self._replace(parts=(*rest, part))


Step = tuple[Following, list[Any]]


def kept_at(state: Following, needed: int, now_ms: int, least_ms: int) -> Kept:
    """How long enough vehicles have done what is required, up to now_ms. least_ms: required duration, 0 never
    completes.
    """
    count = sum(p.there and in_time(p.seen_ms, now_ms, SILENT_MS) for p in state.parts)
    return kept_step(state.kept, count, needed, now_ms, least_ms)


class FollowingTaskService(TaskService):
    """A task that follows an entity."""

    def __init__(self, contexts: Contexts, body: Any, name: str, ended: Callable[[], None]) -> None:
        """body: the task's message; name: of the service."""
        super().__init__(contexts, body.TaskID, name, ended)
        self._body = body
        self._made: tuple[Context, list[Option], list[Dropped]] | None = None
        self._stood: tuple[Context, Tower] | None = None
        self._routed: tuple[Context, Any, tuple[Vec2, ...]] | None = None

    def start(self) -> Any:
        return Following()

    def begin(self, state: Any) -> tuple[Any, Iterable[Any]]:
        lead, out = super().begin(state.lead)
        return state._replace(lead=lead), out

    def stop(self, state: Any) -> None:
        super().stop(state.lead)

    # what the lead offers

    def _still(self, context: Context) -> bool:
        return self._task_in(context).kind is not TaskKind.OTHER

    def _found(self, context: Context) -> tuple[list[Option], list[Dropped]]:
        """The options for the newest request, computed from the entity's motion when first needed."""
        if self._made is None or self._made[0] is not context:
            asked, motion = self._asked(context), self._motion(context)
            found = options_of(context, self._task_in(context), asked, motion)
            self._made = (context, *found)
        return self._made[1], self._made[2]

    def _options(self, context: Context) -> Any:
        return super()._options(context) if self._still(context) else self._found(context)[0]

    def _offer(self, context: Context, options: list[Option]) -> Any:
        if self._still(context):
            return super()._offer(context, options)
        return offered(context, self._task_id, options, self._asked(context).needed)

    def _do(self, state: State, act: int, body: Any, out: list[Any]) -> tuple[State, int]:
        if act == PUBLISH_OPTIONS and not self._still(self._context):
            told = unused_of(self._body, self._contexts.world)
            self._context.withheld[self._task_id] = tuple(self._found(self._context)[1])
            for no in self._found(self._context)[1]:
                who = ", ".join(map(str, no.vehicles))
                who = f"vehicle {who}" if who else no.label or "a place about the entity"
                told.append(f"{who} is not offered for task {self._task_id}: {no.reason}")
            out += [status(self._request, "Warning", [("reason", text)]) for text in told]
        return super()._do(state, act, body, out)

    def _asked(self, context: Context) -> Asked:
        return asked_of(self._body, context.places, self._tower(context))

    def _tower(self, context: Context) -> Tower | None:
        """The tower of a relay, as known when the options were made: towers do not move."""
        if type(self._body).__name__ != "CommRelayTask":
            return None
        if self._stood is None or self._stood[0] is not context:
            self._stood = (context, tower_of(self._body, context.places, self._contexts.world))
        return self._stood[1]

    def _motion(self, context: Context) -> Motion:
        """The motion of the entity; for a relay, of the midpoint between it and the tower."""
        asked = self._asked(context)
        motion = self._moves(context, asked)
        return motion if asked.tower is None else motion.halfway_to(asked.tower.at)

    def _moves(self, context: Context, asked: Asked) -> Motion:
        if asked.stands is not None:
            return Motion(asked.stands, Vec2(0.0, 0.0), 0)
        known = self._contexts.world
        state = known.get("state", asked.entity)
        if state is None:
            raise BadInput(
                f"task {self._task_id} follows an entity of which no message has told",
                where=f"task {self._task_id}",
                item=f"{type(self._body).__name__}: entity",
                expected="one of " + (", ".join(map(str, sorted(known.ids("state")))) or "none"),
                got=str(asked.entity),
            )
        route = self._route(context) or asked.route
        return motion_of(state, context.places, f"state of entity {asked.entity}", route)

    def _route(self, context: Context) -> tuple[Vec2, ...]:
        """The entity's route from the message that the task names; () if it names none."""
        told, along = route_named(self._body, self._contexts.world)
        if self._routed is None or self._routed[0] is not context or self._routed[1] is not told:
            where, found = f"route of task {self._task_id}", []
            within(len(along), 0, TOLD_MOST, where, "number of its places")
            for k, place in enumerate(along):
                pose = context.places.pose(place, 0.0, where, f"[{k}]")
                found.append(Vec2(pose.north_m, pose.east_m))
            self._routed = (context, told, tuple(found))
        return self._routed[2]

    # messages

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        body, topic = envelope.body, envelope.topic
        if topic == MISSION:
            ends = plan_that_ends(envelope)
            return (state, ()) if ends is None else self.handle(state, ends, now_ms)
        if topic == UNIQUE:
            return self._asked_for(state, envelope, now_ms)
        if state.still:
            lead, out = super().handle(state.lead, envelope, now_ms)
            return state._replace(lead=lead), out
        if topic == CHOICE:
            return self._chosen(state, body)
        if topic == RESPONSE:
            return self._planned(state, body)
        if topic == REMOVE and self._task_id in body.TaskList:
            return self._removed(state, body)
        if hasattr(body, "AssociatedTasks"):
            return self._told(state, body)
        out = list[Any]()
        lead, more = super().handle(state.lead, envelope, now_ms)
        out += more
        state = state._replace(lead=lead)
        for part in state.parts:
            own, more = super().handle(part.state, envelope, now_ms)
            if topic == ROUTES:
                more = [parts_of.at_speed(part, one) for one in more]
                part = self._implemented(part, more)
            state = state.with_part(part._replace(state=own))
            out += more if topic == ROUTES else ()
        kept = tuple(part for part in state.parts if part.state.task.state >= FINAL)
        return state._replace(parts=kept), out

    def _implemented(self, part: Part, more: Iterable[Any]) -> Part:
        """The part with the waypoint numbers of its implementation, if that is among the answers."""
        for one in more:
            if type(one).__name__ == "TaskImplementationResponse":
                own = [w for w in one.TaskWaypoints if w.AssociatedTasks]
                waits = any(type(a).__name__ == "LoiterAction" for a in own[0].VehicleActionList)
                return part._replace(begins=own[0].Number + waits, then=own[-1].Number + 1)
        return part

    def _asked_for(self, state: Following, envelope: Envelope, now_ms: int) -> Step:
        """Process a request: one with this task ends the present execution, as for any task."""
        lead, more = super().handle(state.lead, envelope, now_ms)
        out = list(more)
        if lead == state.lead:
            return state, out
        number = envelope.body.RequestID
        context = self._contexts.of(number)
        for part in state.parts:
            _, more = self._advance(part.state, WITHDRAWN, 0, envelope.body)
            out += more
        still = self._still(context)
        return Following(lead, still, now_ms=state.now_ms, plans=state.plans), out

    def _chosen(self, state: Following, body: Any) -> Step:
        """An option is chosen: its vehicle gets a task state of its own."""
        if body.TaskID != self._task_id:
            return state, []
        ticket = state.lead.ticket(body.CorrespondingAutomationRequestID)
        own, out = self._advance(state.lead, CHOSEN, ticket, body)
        if own.chosen is None:
            return state, list(out)
        option = self._option(body)
        return state.with_part(Part(own, option, self._context, 0, 0)), list(out)

    def _planned(self, state: Following, response: Any) -> Step:
        """Process plans: store their waypoints; a plan without this task ends it for its vehicle."""
        out, left = list[Any](), []
        for part in state.parts:
            if self._withdrawn(part.state, response):
                out += self._advance(part.state, WITHDRAWN, 0, response)[1]
            else:
                left.append(part)
        plans = dict(state.plans)
        for part in left:
            for command in response.MissionCommandList:
                if command.VehicleID == part.vehicle:
                    plans[part.vehicle] = _points(part.context, command)
        return state._replace(parts=tuple(left), plans=plans), out

    def _told(self, state: Following, body: Any) -> Step:
        """Process a vehicle's state: its task state, its circle, and whether the task is complete."""
        part = next((p for p in state.parts if p.vehicle == body.ID), None)
        if part is None or part.state.task.state < SELECTED:
            return state, []
        if part.state.away == HANDED_BACK and body.Mode.name == "Waypoint":
            part = part._replace(state=part.state._replace(away=WITH_UXAS))
        if part.state.away:
            return state, []
        number = parts_of.command_id(self._task_id, part.state.task.request)
        follows = parts_of.follows(part, body, number)
        lists = self._task_id in body.AssociatedTasks
        out = list[Any]()
        if lists and part.state.task.state < ACTIVE:
            own, more = self._advance(part.state, LISTED, 0, body)
            part, out = part._replace(state=own), list(more)
        if part.state.task.state < ACTIVE:
            return state, out
        if not (lists or follows):
            # it flies another command, or continued without receiving this task's
            _, more = self._advance(part.state, WITHDRAWN, 0, None)
            rest = tuple(p for p in state.parts if p is not part and p.vehicle != body.ID)
            return state._replace(parts=rest, kept=Kept(-1, False)), [*out, *more]
        now_ms = max(state.now_ms, body.Time, 0)
        asked = self._asked(part.context)
        # a silent vehicle counts as there until its last state
        state = state._replace(now_ms=now_ms, kept=kept_at(state, asked.needed, now_ms, 0))
        waits = not follows and (body.Mode.name != "Waypoint" or body.CurrentWaypoint < part.begins)
        if waits:
            return state.with_part(part), out
        try:
            motion = self._motion(part.context)
        except BadInput as error:
            return self._lost(state, part, error, out)
        if asked.stands is not None:  # a fixed place needs no state
            motion = motion._replace(time_ms=now_ms)
        fresh = in_time(min(motion.time_ms, now_ms), max(motion.time_ms, now_ms), STALE_MS)
        late_s = min(now_ms - motion.time_ms, STALE_MS) / 1000
        motion = motion._replace(at=motion.after(max(late_s, 0.0)))
        before, was = part.blocked, part.there
        part = parts_of.heard(part, body, asked, motion, fresh, now_ms)
        if was and not part.there and asked.tower is not None:
            text = f"vehicle {part.vehicle} is no longer in reach of the tower and what it supports"
            out.append(self._warning(text))
        if part.blocked and part.blocked != before:
            text = f"vehicle {part.vehicle} does not follow: {part.blocked} lies in the way"
            out.append(self._warning(text))
        elif part.held is not None and not part.blocked:
            out.append(parts_of.circling(part, self._task_id, number, asked, motion))
        state = state.with_part(part)
        kept = kept_at(state, asked.needed, now_ms, asked.least_ms)
        state = state._replace(kept=kept)
        return self._over(state, body, out) if kept.done else (state, out)

    def _lost(self, state: Following, part: Part, error: BadInput, out: list[Any]) -> Step:
        """The entity's position is unknown: the vehicle does not count as there, and that is reported once."""
        asked = self._asked(part.context)
        if part.blocked != LOST:
            out.append(self._warning(f"vehicle {part.vehicle} does not follow: {error}"))
        state = state.with_part(part._replace(there=False, seen_ms=state.now_ms, blocked=LOST))
        return state._replace(kept=kept_at(state, asked.needed, state.now_ms, asked.least_ms)), out

    def _over(self, state: Following, body: Any, out: list[Any]) -> Step:
        """The task is complete: the vehicles are released."""
        involved = sorted(part.vehicle for part in state.parts)
        out.append(
            lmcp.new(
                "TaskComplete",
                TaskID=self._task_id,
                EntitiesInvolved=involved,
                TimeTaskCompleted=body.Time,
            )
        )
        for part in state.parts:
            _, more = self._advance(part.state, UNLISTED, 0, body)
            out += [one for one in more if type(one).__name__ != "TaskComplete"]
            out += self._let_go(state, part)
        return state._replace(parts=(), kept=Kept(-1, False)), out

    def _let_go(self, state: Following, part: Part) -> list[Any]:
        """The command that lets a vehicle continue its plan after completion."""
        return [self._sent_on(state, part)]

    def _removed(self, state: Following, body: Any) -> Step:
        """The task is removed: it ends undone, and its vehicles continue their plans."""
        out = [one for p in state.parts for one in self._advance(p.state, WITHDRAWN, 0, body)[1]]
        out += self._sent(state)
        return state._replace(parts=(), kept=Kept(-1, False), meeting=None), out

    def _sent(self, state: Following) -> list[Any]:
        """Vehicles that were commanded to circle continue their plans."""
        return [self._sent_on(state, part) for part in state.parts if part.held is not None]

    def _sent_on(self, state: Following, part: Part) -> Any:
        """The command that lets a vehicle continue its plan, or a Warning why it stays on its circle."""
        number = parts_of.command_id(self._task_id, part.state.task.request)
        points = state.plans.get(part.vehicle, {})
        command, why = parts_of.released(part, self._task_id, number, points)
        if command is None:
            return self._warning(f"vehicle {part.vehicle} stays on its circle: {why}")
        return command

    def _warning(self, text: str) -> Any:
        told = [("TaskID", str(self._task_id)), ("reason", f"task {self._task_id}: {text}")]
        return status(0, "Warning", told)


def _points(context: Context, command: Any) -> dict[int, Position]:
    """The waypoints of a plan by number."""
    found = {}
    for w in command.WaypointList:
        pose = context.places.pose(w, 0.0, f"MissionCommand {command.CommandID}", f"{w.Number}")
        found[w.Number] = Position(*pose[:3])
    return found
