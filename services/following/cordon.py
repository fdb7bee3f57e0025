"""The service of a cordon: vehicles that drive block every road that crosses the circle about a place.

It asks the OsmPlannerService where roads cross the circle (EgressRouteRequest). An option is one vehicle at one of
these places; offered is a choice of all ways to give each place a vehicle of its own. Each drives there along roads
and stands. Complete: all of them stand at their places at one time for as long as is asked.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.timeliness import lasted
from cratous.core.kernel import Vec2
from cratous.core.tasks.stations import in_ring
from cratous.services.bus import Envelope
from cratous.services.following.asked import (
    DURATION,
    DURATION_MOST_MS,
    STANDOFF_MOST_M,
    milliseconds,
    within,
)
from cratous.services.following.blocking import Told, options_of
from cratous.services.following.offering import choice
from cratous.services.following.part import Part
from cratous.services.following.service import (
    SELECTED,
    Following,
    FollowingTaskService,
    Step,
    kept_at,
)
from cratous.services.pipeline.contexts import Context, Contexts
from cratous.services.pipeline.ground import ROADS
from cratous.services.pipeline.implementation import ROUNDED_MS
from cratous.services.pipeline.tasks import (
    ACTIVE,
    LISTED,
    ROUTES_KNOWN,
    State,
)
from cratous.services.planning.flyers import MOMENT_MS
from cratous.services.planning.options import Dropped, Option
from cratous.spec.errors import BadInput, NoPlan

EGRESS = "uxas.messages.route.EgressRouteResponse"
PLACE_M = 20.0
"""Who is no farther from its place blocks the road there."""


AWAITS_PLACES = 3
"""The task's state (OptionRoutes of `spec.contracts.tasks`) in which it waits for where roads cross the circle."""


class CordonTaskService(FollowingTaskService):
    """One cordon."""

    subscribes: tuple[str, ...] = (*FollowingTaskService.subscribes, EGRESS)

    def __init__(self, contexts: Contexts, body: Any, name: str, ended: Callable[[], None]) -> None:
        super().__init__(contexts, body, name, ended)
        self._roads: Told | None = None
        self._ways: list[list[int]] = []

    # what is offered

    def _still(self, context: Context) -> bool:
        return False

    @property
    def _radius_m(self) -> float:
        radius = float(self._body.StandoffDistance)
        within(radius, 1, STANDOFF_MOST_M, f"task {self._task_id}", "StandoffDistance")
        return radius

    @property
    def _least_ms(self) -> int:
        return milliseconds(self._body, DURATION, DURATION_MOST_MS, MOMENT_MS)

    def _ask_routes(self, state: State, body: Any, out: list[Any]) -> tuple[State, int]:
        """In the place of the options' ways: the places of which the options are made."""
        context, middle, where = self._context, self._body.CordonLocation, f"task {self._task_id}"
        context.places.pose(middle, 0.0, where, "CordonLocation")
        radius = self._radius_m
        if not self._contexts.source.asks(ROADS):
            self._hear(Told(context, (), f"no {ROADS} is here, which knows the roads"))
            return state, ROUTES_KNOWN
        out.append(
            lmcp.new(
                "EgressRouteRequest", RequestID=self._task_id, StartLocation=middle, Radius=radius
            )
        )
        return state, 0

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        if envelope.topic != EGRESS:
            return super().handle(state, envelope, now_ms)
        body, lead = envelope.body, state.lead
        if body.ResponseID != self._task_id or lead.task.state != AWAITS_PLACES:
            return state, ()
        context, count = self._contexts.of(lead.number(lead.task.request)), len(body.NodeLocations)
        headings = [*body.Headings, *[0.0] * count]
        self._hear(Told(context, tuple(zip(body.NodeLocations, headings, strict=False))))
        lead, out = self._advance(lead, ROUTES_KNOWN, lead.task.request, body)
        return state._replace(lead=lead), out

    def _hear(self, told: Told) -> None:
        """What was made of what was told before holds no longer."""
        self._roads, self._made = told, None

    def _found(self, context: Context) -> tuple[list[Option], list[Dropped]]:
        told = self._roads
        if told is None or told.context is not context:
            told = Told(context, (), "nobody has said which roads there are")
        if self._made is None or self._made[0] is not context:
            found = options_of(
                context, self._task_in(context), told, self._radius_m, self._least_ms
            )
            self._made, self._ways = (context, found[0], found[2]), found[1]
        return self._made[1], self._made[2]

    def _offer(self, context: Context, options: list[Option]) -> Any:
        self._found(context)
        return choice(context, self._task_id, options, self._ways)

    def _plan(self, request: Any, response: Any) -> list[Any]:
        """Its way along roads; NoPlan where it would have to wait before, which nothing that drives is told."""
        plan = response.RouteResponses[0] if response.RouteResponses else None
        if plan is not None and not plan.RouteCost < 0:
            wait = max(0, request.TimeThreshold - request.StartTime - plan.RouteCost)
            if lasted(0, wait, ROUNDED_MS):
                text = f"vehicle {request.VehicleID} would have to wait {wait / 1000:.3f} s before task"
                raise NoPlan((f"{text} {self._task_id}, and what drives is not told to",))
        return [self._standing(one) for one in super()._plan(request, response)]

    def _standing(self, said: Any) -> Any:
        """With the action to stand at the place for as long as is asked, before the plan goes on from there."""
        if type(said).__name__ != "TaskImplementationResponse":
            return said
        *way, last = said.TaskWaypoints
        stand = lmcp.new(
            "LoiterAction",
            AssociatedTaskList=[self._task_id],
            LoiterType="Hover",
            Duration=self._least_ms,
            Location=said.FinalLocation,
        )
        return said.copy(TaskWaypoints=[*way, last.copy(VehicleActionList=[stand])])

    # what is driven

    def _told(self, state: Following, body: Any) -> Step:
        """A vehicle's state: its life, and whether all stand where they have to."""
        part = next((p for p in state.parts if p.vehicle == body.ID), None)
        if part is None or part.state.task.state < SELECTED:
            return state, []
        now_ms, out = max(state.now_ms, body.Time, 0), list[Any]()
        needed = len(self._ways[0]) if self._ways else 0
        # who was silent until now was there until then, not since
        state = state._replace(now_ms=now_ms, kept=kept_at(state, needed, now_ms, 0))
        there, why = self._stands(part, body)
        if why and not part.blocked:
            out.append(self._warning(f"vehicle {part.vehicle} is not at its place: {why}"))
        elif part.there and not there:
            out.append(self._warning(f"vehicle {part.vehicle} has left the road that it blocks"))
        if (there or self._task_id in body.AssociatedTasks) and part.state.task.state < ACTIVE:
            own, more = self._advance(part.state, LISTED, 0, body)
            part, out = part._replace(state=own), [*out, *more]
        state = state.with_part(part._replace(there=there, seen_ms=now_ms, blocked=why))
        state = state._replace(kept=kept_at(state, needed, now_ms, self._least_ms))
        return self._over(state, body, out) if state.kept.done else (state, out)

    def _stands(self, part: Part, body: Any) -> tuple[bool, str]:
        """Whether a vehicle is at its place by its state; why that says nothing."""
        where, at = f"state of vehicle {body.ID}", part.option.path[0]
        try:
            here = part.context.places.pose(body.Location, 0.0, where, "Location")
        except BadInput as error:
            return False, str(error)
        return in_ring(Vec2(*at[:2]), Vec2(*here[:2]), 0.0, PLACE_M), ""

    def _let_go(self, state: Following, part: Part) -> list[Any]:
        """Nothing: it stays where it is, as its plan ends there, or goes on in this by itself."""
        return []
