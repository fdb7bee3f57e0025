"""The service of a cordon: ground vehicles block every road that crosses the circle around a place.

It asks the OsmPlannerService for the road crossings (EgressRouteRequest). An option is one vehicle at one
crossing; the offer is a choice among the combinations that assign a vehicle to each. Each drives to its place
along roads, and is commanded to stay there until the last has arrived. The task is complete when all have
stood at their places together for the required time; then each continues its plan.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import isfinite
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.timeliness import lasted
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.core.routing.visibility import name_of
from cratous.core.tasks.stations import in_ring, outruns
from cratous.services.bus import Envelope
from cratous.services.following.blocking import Told, options_of
from cratous.services.following.service import (
    SELECTED,
    SILENT_MS,
    Following,
    FollowingTaskService,
    Step,
    kept_at,
)
from cratous.services.following.task_options import choice
from cratous.services.following.task_parameters import (
    DURATION,
    DURATION_MOST_MS,
    STANDOFF_MOST_M,
    milliseconds,
    within,
)
from cratous.services.following.vehicle_part import Part, command_id
from cratous.services.pipeline.contexts import Context, Contexts
from cratous.services.pipeline.ground import ROADS
from cratous.services.pipeline.implementation import ROUNDED_MS
from cratous.services.pipeline.task_state import State
from cratous.services.pipeline.tasks import (
    ACTIVE,
    LISTED,
    ROUTES_KNOWN,
)
from cratous.services.planning.options import Dropped, Option
from cratous.services.planning.performance_classes import MOMENT_MS
from cratous.spec.errors import BadInput, NoPlan

EGRESS = "uxas.messages.route.EgressRouteResponse"
PLACE_M, STANDS_M_S = 20.0, 0.5
"""A vehicle within this distance [m] of its place and below this speed [m/s] blocks the road."""


AWAITS_PLACES = 3
"""Task state (OptionRoutes of `spec.contracts.tasks`) in which it waits for the road crossings."""


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
        """Ask for the road crossings from which the options are made, instead of the options' routes."""
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
        """Store the road crossings, and discard the options made from earlier ones."""
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
        """The route along roads; if the vehicle has to wait, it stands at the beginning of the route."""
        plan, wait = response.RouteResponses[0] if response.RouteResponses else None, 0
        if plan is not None and not plan.RouteCost < 0:
            wait = max(0, request.TimeThreshold - request.StartTime - plan.RouteCost)
        if not lasted(0, wait, ROUNDED_MS):
            return [self._standing(one, 0) for one in super()._plan(request, response)]
        soon = request.copy(TimeThreshold=request.StartTime)
        return [self._standing(one, wait) for one in super()._plan(soon, response)]

    def _standing(self, said: Any, wait: int) -> Any:
        """The response with actions to wait [ms] at the beginning of the route, and to stand at the place
        before the plan continues. It stands slightly longer than required, so that it is commanded to stay
        before it would leave.
        """
        if type(said).__name__ != "TaskImplementationResponse":
            return said
        *way, last = said.TaskWaypoints
        stand = self._stand(self._least_ms + SILENT_MS, said.FinalLocation)
        ways = [*way, last.copy(VehicleActionList=[stand])]
        if wait:
            first = ways[0]
            if not way:
                raise NoPlan(
                    (f"vehicle {said.VehicleID} has to wait, and its way is of one place",)
                )
            at = lmcp.new("Location3D", Latitude=first.Latitude, Longitude=first.Longitude)
            ways[0] = first.copy(VehicleActionList=[self._stand(wait, at)])
        return said.copy(TaskWaypoints=ways, FinalTime=said.FinalTime + wait)

    def _stand(self, duration: int, place: Any) -> Any:
        """The action to stand at a place for `duration` [ms], -1 for until further command."""
        return lmcp.new(
            "LoiterAction",
            AssociatedTaskList=[self._task_id],
            LoiterType="Hover",
            Duration=duration,
            Location=place,
        )

    # what is driven

    def _implemented(self, part: Part, more: Iterable[Any]) -> Part:
        """A vehicle that waits at the beginning of its route is not at its place until it has left there."""
        more = list(more)
        part = super()._implemented(part, more)
        for one in more:
            if type(one).__name__ == "TaskImplementationResponse":
                first = one.TaskWaypoints[0]
                return part._replace(begins=first.Number + 1 if first.VehicleActionList else 0)
        return part

    def _told(self, state: Following, body: Any) -> Step:
        """Process a vehicle's state: its task state, and whether all stand at their places."""
        part = next((p for p in state.parts if p.vehicle == body.ID), None)
        if part is None or part.state.task.state < SELECTED:
            return state, []
        now_ms, out = max(state.now_ms, body.Time, 0), list[Any]()
        needed = len(self._ways[0]) if self._ways else 0
        # a silent vehicle counts as there until its last state
        state = state._replace(now_ms=now_ms, kept=kept_at(state, needed, now_ms, 0))
        number = command_id(self._task_id, part.state.task.request)
        there, why = self._stands(part, body)
        begun = body.CurrentCommand == number or body.CurrentWaypoint not in range(part.begins)
        there = there and begun
        if why and not part.blocked:
            out.append(self._warning(f"vehicle {part.vehicle} is not at its place: {why}"))
        elif part.there and not there:
            out.append(self._warning(f"vehicle {part.vehicle} has left the road that it blocks"))
        if (there or self._task_id in body.AssociatedTasks) and part.state.task.state < ACTIVE:
            own, more = self._advance(part.state, LISTED, 0, body)
            part, out = part._replace(state=own), [*out, *more]
        state = state.with_part(part._replace(there=there, seen_ms=now_ms, blocked=why))
        state = state._replace(kept=kept_at(state, needed, now_ms, self._least_ms))
        if state.kept.done:
            return self._over(state, body, out)
        # no vehicle leaves before the last has arrived; one not yet on its last leg would leave the road for
        # its place
        if there and self._task_id in body.AssociatedTasks and body.CurrentCommand != number:
            stay = self._stand(-1, part.context.places.sent(part.option.end)[0])
            out.append(self._order(part, stay))
        return state, out

    def _stands(self, part: Part, body: Any) -> tuple[bool, str]:
        """Whether a vehicle stands at its place according to its state, and why its state is unusable, if it
        is.
        """
        where, at = f"state of vehicle {body.ID}", part.option.path[0]
        try:
            here = part.context.places.pose(body.Location, 0.0, where, "Location")
        except BadInput as error:
            return False, str(error)
        if not isfinite(body.Groundspeed):
            return False, "its Groundspeed is no number"
        stands = outruns(Vec2(body.Groundspeed, 0.0), STANDS_M_S)
        return stands and in_ring(Vec2(*at[:2]), Vec2(*here[:2]), 0.0, PLACE_M), ""

    def _let_go(self, state: Following, part: Part) -> list[Any]:
        """The command to the next waypoint of a vehicle's plan, if there is one."""
        goal = state.plans.get(part.vehicle, {}).get(part.then)
        if goal is None:
            return []
        leg = first_bad_leg((part.option.path[0], goal), part.context.inputs.zones)
        if leg is not None:
            who = f"vehicle {part.vehicle} stays at its place"
            return [self._warning(f"{who}: {name_of(leg[1])} keeps it from its plan")]
        return [self._order(part, lmcp.new("GoToWaypointAction", WaypointNumber=part.then))]

    def _sent(self, state: Following) -> list[Any]:
        """Vehicles that were commanded to stay continue their plans."""
        return [one for part in state.parts if part.there for one in self._let_go(state, part)]

    def _order(self, part: Part, action: Any) -> Any:
        return lmcp.new(
            "VehicleActionCommand",
            CommandID=command_id(self._task_id, part.state.task.request),
            VehicleID=part.vehicle,
            VehicleActionList=[action],
        )
