"""Routes that ICAROUS plans for UxAS: RoutePlanRequest to WPREQ, RPRSP to RoutePlanResponse.

Each RouteConstraints of a request for waypoints becomes one WPREQ, to the vehicle's own instance or else to
that of the lowest vehicle id; an instance has one at a time, the others are queued. The answer contains only
places: they are connected by flyable turns, and the proved kernels check each leg as those of any route
(`services.planning.vias`). If there is no instance, no answer in time, or an invalid one, UxAS's own planner
plans the route, and log, RoutePlan and a ServiceStatus give the reason.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.bridge.port import is_due
from cratous.bridge.text_protocol import (
    RouteEnd,
    RoutePoint,
    RouteRequest,
    RouteStart,
)
from cratous.services.bus import Envelope
from cratous.services.flight.messages import Down, Say
from cratous.services.icarous_communication.listeners import Dialects
from cratous.services.icarous_communication.state import Note, Out, Refuse
from cratous.services.mission.frames import compass
from cratous.services.pipeline import planner
from cratous.services.pipeline.contexts import Contexts, reasons_of
from cratous.services.pipeline.status import status
from cratous.spec.errors import CratousError

PLANNERS = ("GRID", "ASTAR", "RRT", "SPLINE")
"""The planners of RoutePlannerUsed 0 to 3, by their names in WPREQ."""
REQUEST, GROUP = "uxas.messages.route.RoutePlanRequest", "IcarousPathPlanner"
MOST_POINTS = 256
"""A longer answer is rejected."""
MOST_WAITING = 1000
"""Most queued routes; UxAS's own planner plans further ones at once."""
FAILURES = (CratousError, MemoryError)
"""Expected failures of planning one route, including lack of memory."""
RouteLine = RouteStart | RoutePoint | RouteEnd


class Request(NamedTuple):
    """A RoutePlanRequest in progress. plans: by position in it; said: reasons reported for routes that UxAS
    planned.
    """

    asked: Envelope
    plans: dict[int, Any]
    said: set[str]


class Wanted(NamedTuple):
    """One requested route: request and position in it."""

    ticket: int
    position: int


class Outstanding(NamedTuple):
    """A pending WPREQ. until_s: deadline, None until the first `look` after it was sent; places: received so
    far, None before the answer begins; told: how many were received.
    """

    wanted: Wanted
    number: int
    until_s: float | None = None
    places: tuple[tuple[float, float, float], ...] | None = None
    told: int = 0


class Routes:
    """Route requests of one service. kind: one of PLANNERS; wait_s: limit for an answer [s]."""

    def __init__(
        self, name: str, contexts: Contexts, kind: int, wait_s: float, dialects: Dialects
    ) -> None:
        self._name, self._contexts, self._wait_s = name, contexts, wait_s
        self._kind, self._dialects = PLANNERS[kind], dialects
        self._requests: dict[int, Request] = {}
        self._waiting: deque[Wanted] = deque()
        self._out: dict[int, Outstanding] = {}
        self._mute: set[int] = set()  # instances that owe an answer
        self._tickets = self._numbers = 0

    def begun(self) -> Say:
        """The message that UxAS's own planner leaves route requests to ICAROUS."""
        text = f"{self._name}: ICAROUS plans the routes ({self._kind})"
        return Say(lmcp.new("OwnRoutePlanner", Plans=False, Reason=text), self._name)

    def asked(self, envelope: Envelope) -> list[Out]:
        """Queue the routes of a RoutePlanRequest; cost-only requests are left to UxAS's own planner."""
        body = envelope.body
        if body.IsCostOnlyRequest:
            return []
        self._tickets += 1
        self._requests[self._tickets] = Request(envelope, {}, set())
        wanted = [Wanted(self._tickets, k) for k in range(len(body.RouteRequests))]
        room = MOST_WAITING - len(self._waiting)
        self._waiting.extend(wanted[:room])
        out: list[Out] = []
        for one in wanted[room:]:
            out += self._own(one, f"more than {MOST_WAITING} ways wait for ICAROUS")
        return out if wanted else [*out, *self._answered(self._tickets)]

    def look(self, now_s: float) -> list[Out]:
        """Give up overdue requests. The time for an answer starts at the first call after the WPREQ was sent,
        so that delays of this process do not count.
        """
        out: list[Out] = []
        for vid, one in list(self._out.items()):
            if one.until_s is None:
                self._out[vid] = one._replace(until_s=now_s + self._wait_s)
            elif is_due(one.until_s, now_s):
                out += self._overdue(vid)
        return out

    def step(self, seated: Sequence[int]) -> list[Out]:
        """Send queued requests to instances that are free. seated: vehicles whose instances are connected."""
        out: list[Out] = []
        kept: deque[Wanted] = deque()
        while self._waiting:
            wanted = self._waiting.popleft()
            vid = self._chosen(wanted, seated)
            if vid is None:
                out += self._own(wanted, "no ICAROUS is connected that answers")
            elif vid in self._out:
                kept.append(wanted)
            else:
                out += self._sent(vid, wanted)
        self._waiting = kept
        return out

    def heard(self, vid: int, line: RouteLine) -> list[Out]:
        """Process a line of an answer from a vehicle's instance."""
        one = self._out.get(vid)
        if isinstance(line, RouteEnd):
            self._mute.discard(vid)
        if one is None:
            return [Refuse("route that nobody waits for", f"vehicle {vid}: {line}")]
        if self._dialects.of(vid).ours and line.request != one.number:
            detail = f"vehicle {vid}: expected {one.number}, got {line.request}"
            return [Refuse("route of another request", detail)]
        if isinstance(line, RouteStart):
            self._out[vid] = one._replace(places=(), told=0)
            return []
        if one.places is None:
            return [Refuse("route without its beginning", f"vehicle {vid}: {line}")]
        if isinstance(line, RoutePoint):
            place = (line.lat_deg, line.long_deg, line.alt_m)
            more = (*one.places, place) if len(one.places) in range(MOST_POINTS) else one.places
            self._out[vid] = one._replace(places=more, told=one.told + 1)
            return []
        return self._ended(vid, one, one.places)

    def gone(self, vid: int) -> list[Out]:
        """An instance's connection has closed: UxAS plans its pending route."""
        self._mute.discard(vid)
        one = self._out.pop(vid, None)
        return [] if one is None else self._own(one.wanted, _of(vid, "the connection has ended"))

    def _chosen(self, wanted: Wanted, seated: Sequence[int]) -> int | None:
        own = int(self._requests[wanted.ticket].asked.body.VehicleID)
        able = [vid for vid in seated if vid not in self._mute]
        return own if own in able else min(able, default=None)

    def _sent(self, vid: int, wanted: Wanted) -> list[Out]:
        """Send the WPREQ of a route; if the request cannot be resolved, UxAS's own planner reports why."""
        body = self._requests[wanted.ticket].asked.body
        try:
            places, way = planner.asked_way(
                self._contexts, body, body.RouteRequests[wanted.position]
            )
        except FAILURES as error:
            return self._own(wanted, _why(error))
        self._numbers += 1
        vehicle, to_geodetic = places.mission.vehicle(body.VehicleID), places.projection.to_geodetic
        start, end = way
        line = RouteRequest(
            self._kind,
            *to_geodetic(start.north_m, start.east_m),
            start.alt_m,
            *to_geodetic(end.north_m, end.east_m),
            end.alt_m,
            compass(start.heading_rad),
            vehicle.speed_m_s,
            0.0,
            self._numbers,
        )
        self._out[vid] = Outstanding(wanted, self._numbers)
        return [Down(vid, (line,))]

    def _overdue(self, vid: int) -> list[Out]:
        """An overdue answer: the instance gets no further request until it finishes its answer or reconnects."""
        self._mute.add(vid)
        why = _of(vid, f"no answer within {self._wait_s:g} s")
        return self._own(self._out.pop(vid).wanted, why)

    def _ended(
        self, vid: int, one: Outstanding, places: tuple[tuple[float, float, float], ...]
    ) -> list[Out]:
        plan, why = None, "it has found no way"
        request = self._requests[one.wanted.ticket]
        body = request.asked.body
        if one.told not in range(MOST_POINTS + 1):
            why = f"its way has {one.told} places, more than {MOST_POINTS}"
        elif places:
            constraint = body.RouteRequests[one.wanted.position]
            try:
                plan, why = planner.led_over(self._contexts, body, constraint, places)
            except FAILURES as error:
                why = _why(error)
        del self._out[vid]
        if plan is None:
            return self._own(one.wanted, _of(vid, why))
        request.plans[one.wanted.position] = plan
        return self._complete(one.wanted.ticket)

    def _own(self, wanted: Wanted, why: str) -> list[Out]:
        """Let UxAS's own planner plan a route, and report why."""
        request = self._requests[wanted.ticket]
        body = request.asked.body
        constraint = body.RouteRequests[wanted.position]
        try:
            (plan,) = planner.plans_of(self._contexts, body, [constraint])
        except FAILURES as error:
            plan = planner.refused(getattr(constraint, "RouteID", 0), (_why(error),))
        text = f"route of vehicle {body.VehicleID} planned by UxAS: {why}"
        plan.RouteError = [*plan.RouteError, lmcp.new("KeyValuePair", Key="reason", Value=text)]
        request.plans[wanted.position] = plan
        out: list[Out] = []
        if text not in request.said:  # once per request, however many routes it concerns
            request.said.add(text)
            facts = [("VehicleID", str(body.VehicleID)), ("reason", text)]
            out = [Note("WARN", text), Say(status(0, "Warning", facts), self._name)]
        return [*out, *self._complete(wanted.ticket)]

    def _complete(self, ticket: int) -> list[Out]:
        request = self._requests[ticket]
        if len(request.plans) != len(request.asked.body.RouteRequests):
            return []
        return self._answered(ticket)

    def _answered(self, ticket: int) -> list[Out]:
        """The response to a request whose routes are all planned."""
        request = self._requests.pop(ticket)
        body = request.asked.body
        plans = [request.plans[k] for k in range(len(body.RouteRequests))]
        by_icarous = sum(not plan.RouteError for plan in plans)
        text = f"routes of vehicle {body.VehicleID}: {by_icarous} of {len(plans)} by ICAROUS"
        return [Note("INFO", text), Say(planner.answered(request.asked, plans), self._name)]


def _why(error: CratousError | MemoryError) -> str:
    """The reason in words; a failure of one route neither ends UxAS nor leaves its request unanswered."""
    if isinstance(error, CratousError):
        return "; ".join(reasons_of(error))
    return f"it cannot be planned: {error!r}"


def _of(vid: int, why: str) -> str:
    return f"ICAROUS of vehicle {vid}: {why}"
