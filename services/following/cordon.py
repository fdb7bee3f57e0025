"""The service of a cordon: vehicles that drive block every road that crosses the circle about a place.

It asks the OsmPlannerService where roads cross the circle (EgressRouteRequest). An option is one vehicle at one of
these places; offered is a choice of all ways to give each place a vehicle of its own. Each drives there along roads
and stands. Complete: all of them stand at their places at one time for as long as is asked.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import permutations
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.authority.timeliness import lasted
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.core.routing.visibility import name_of
from cratous.core.tasks.stations import Kept, in_ring
from cratous.services.bus import Envelope
from cratous.services.following.asked import (
    DURATION,
    DURATION_MOST_MS,
    STANDOFF_MOST_M,
    milliseconds,
    within,
)
from cratous.services.following.offering import WAYS_MOST, choice
from cratous.services.following.part import Part
from cratous.services.following.service import (
    SELECTED,
    Following,
    FollowingTaskService,
    Step,
    kept_at,
)
from cratous.services.loading.ground import drives
from cratous.services.pipeline.contexts import Context, Contexts
from cratous.services.pipeline.ground import ROADS
from cratous.services.pipeline.implementation import ROUNDED_MS
from cratous.services.pipeline.tasks import (
    ACTIVE,
    LISTED,
    ROUTES_KNOWN,
    UNLISTED,
    State,
)
from cratous.services.planning.flyers import MOMENT_MS, flyer_of
from cratous.services.planning.options import Dropped, Option
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission import Position, Task
from cratous.spec.mission.plan import Pose

EGRESS = "uxas.messages.route.EgressRouteResponse"
ROADS_MOST = 32
"""So many places the response has at most, by its definition."""
PLACE_M = 20.0
"""Who is no farther from its place blocks the road there."""


AWAITS_PLACES = 3
"""The task's state (OptionRoutes of `spec.contracts.tasks`) in which it waits for where roads cross the circle."""


class Told(NamedTuple):
    """Where roads cross the circle, for one request: places and headings outwards [deg]; why: nobody has said."""

    context: Context
    crossings: tuple[tuple[Any, float], ...]
    why: str = ""


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
            self._roads = Told(context, (), f"no {ROADS} is here, which knows the roads")
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
        told = Told(context, tuple(zip(body.NodeLocations, headings, strict=False)))
        if count > ROADS_MOST:
            told = Told(context, (), f"{count} roads cross the circle, more than {ROADS_MOST}")
        self._roads = told
        lead, out = self._advance(lead, ROUTES_KNOWN, lead.task.request, body)
        return state._replace(lead=lead), out

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
        return super()._plan(request, response)

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

    def _over(self, state: Following, body: Any, out: list[Any]) -> Step:
        """Complete; the vehicles stay where they are, as their plans end there, or go on in these."""
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
        return state._replace(parts=(), kept=Kept(-1, False)), out


def options_of(
    context: Context, task: Task, told: Told, radius_m: float, least_ms: int
) -> tuple[list[Option], list[list[int]], list[Dropped]]:
    """An option for each vehicle and place, all ways to give each place a vehicle, and what is not offered."""
    vehicles, count = context.inputs.mission.vehicles, len(told.crossings)
    may = [v for v in vehicles if not task.eligible or v.id in task.eligible]
    able = [v for v in may if drives(v)]
    flying = tuple(v.id for v in may if not drives(v))
    reason = "it does not drive, and blocks no road"
    dropped = [Dropped(task.id, flying, "", reason)] if flying else []
    places = [_pose(context, task, k, told.crossings[k]) for k in range(count)]
    why = told.why or _why_none(context, places, len(able), radius_m)
    if why:
        who = tuple(v.id for v in able or may)
        return [], [], [*dropped, Dropped(task.id, who, "a cordon", why)]
    made, numbers = list[Option](), dict[tuple[int, int], int]()
    for vehicle in able:
        flyer = flyer_of(vehicle)
        for k, pose in enumerate(places):
            number = numbers[vehicle.id, k] = len(made) + 1
            pose = pose._replace(alt_m=flyer.alt_m)
            ids, path = (task.id, number, (vehicle.id,)), (Position(*pose[:3]),)
            label = f"road {k + 1} of {count}"
            made.append(Option(*ids, flyer, pose, pose, path, least_ms, (), label))
    ways = [
        [numbers[vehicle, k] for k, vehicle in enumerate(chosen)]
        for chosen in permutations([v.id for v in able], count)
    ]
    return made, ways, dropped


def _pose(context: Context, task: Task, k: int, crossing: tuple[Any, float]) -> Pose:
    return context.places.pose(*crossing, f"task {task.id}", f"NodeLocations[{k}]")


def _why_none(context: Context, places: Sequence[Pose], able: int, radius_m: float) -> str:
    """Why roads cannot all be blocked, nothing if they can."""
    count = len(places)
    if not count:
        return f"{ROADS} knows no road that crosses the circle of {radius_m:g} m"
    if able < count:
        return (
            f"{count} roads cross the circle of {radius_m:g} m, and {able} vehicles may block one"
        )
    if math.perm(able, count) > WAYS_MOST:
        return (
            f"{able} vehicles may block {count} roads in more than {WAYS_MOST} ways: "
            "name fewer as EligibleEntities"
        )
    for k, pose in enumerate(places):
        bad = first_bad_leg((Position(*pose[:3]),), context.inputs.zones)
        if bad is not None:
            return f"road {k + 1} of {count} would be blocked in breach of {name_of(bad[1])}"
    return ""
