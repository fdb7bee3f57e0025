"""What the messages mean: the world as they have told it, and each request as a mission in it.

A service of the pipeline works from messages alone. What follows from a UniqueAutomationRequest and
the messages before it (mission, zones, options) is a function of them; it is computed when first
asked for and kept for the newest requests, so that services of one process do not compute it twice.
In another process the same messages give the same. A service that stands on it names in `knows` what
it reads there. Frame: the mission's, from the loader.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import radians
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.loading.places import Places
from cratous.services.loading.uxas import mission_of, surroundings_of
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_parts import point
from cratous.services.pipeline.world import World
from cratous.services.planning import stages
from cratous.services.planning.desk import Desk, Inputs
from cratous.services.planning.routes import Routes
from cratous.services.planning.zones import hard_zones
from cratous.services.uxas.frame import Host
from cratous.spec.errors import BadInput, CratousError, NoPlan
from cratous.spec.mission import Mission, Position
from cratous.spec.plan import Pose

UNIQUE = "uxas.messages.task.UniqueAutomationRequest"
IMPACT = "afrl.impact.ImpactAutomationRequest"
IMPACT_ANSWER = "afrl.impact.ImpactAutomationResponse"
_OF_ZONES = -1  # no region that comes in a message is this one
KEPT = 8
"""Requests whose meaning is kept."""
MOST_OVERRIDDEN = 1000


class Way(NamedTuple):
    """From where to where, as `Routes` takes it: from a way's own `end` to its own `start`."""

    end: Pose
    start: Pose


class RequestDesk(Desk):
    """Places of one request: messages have degrees, the mission's frame has metres.

    A place that was sent from here is read as exactly the point that it was.
    """

    def __init__(self, mission: Mission) -> None:
        super().__init__(mission)
        self._points: dict[tuple[float, float, float], Position] = {}
        self._places = Places(mission.frame)
        self.found: Inputs | None = None
        self._routes: Routes | None = None

    def routes_of(self, ways: list[Way]) -> Routes:
        """Routes of the mission's vehicles: way k is that from k to k. What is found is kept."""
        if self._routes is None:
            starts = {v.id: Pose(*v.position, v.heading_rad) for v in self.mission.vehicles}
            self._routes = Routes(self.mission, starts, (), hard_zones(self.mission.zones))
        self._routes.options = ways  # type: ignore[assignment]
        return self._routes

    def inputs(self, request_id: int) -> Inputs:
        """What follows from the one request of this desk."""
        assert self.found is not None
        return self.found

    def location(self, point: Position | Pose) -> Any:
        """A point as Location3D (degrees, metres MSL)."""
        made = super().location(point)
        self._points[made.Latitude, made.Longitude, made.Altitude] = Position(*point[:3])
        return made

    def pose(self, location: Any, heading_deg: float, where: str, item: str) -> Pose:
        """A Location3D and a heading as a pose of the frame; BadInput for what is no place."""
        if location is None:
            raise BadInput("a place is missing", where=where, item=item, expected="a Location3D")
        known = self._points.get((location.Latitude, location.Longitude, location.Altitude))
        if known is None:
            known = point(location, self._places, Sent(None, where, 0), item)
        return Pose(*known, radians(heading_deg))


class Context:
    """One UniqueAutomationRequest and the mission that it asks for."""

    def __init__(self, request: Any, inputs: Inputs, desk: RequestDesk) -> None:
        self.request, self.inputs, self.desk = request, inputs, desk
        desk.found = inputs
        self.offered: set[int] = set()  # tasks whose options were computed here

    @property
    def vehicles(self) -> list[int]:
        """The vehicles that it is for; no EntityList means all that are known."""
        return [vehicle.id for vehicle in self.inputs.mission.vehicles]

    @property
    def region(self) -> int:
        """The operating region, 0 for none."""
        return int(self.request.OriginalRequest.OperatingRegion)


class Contexts:
    """A service without a part of its own: hears the world, and each request as it is published."""

    name = "WorldState"
    subscribes: tuple[str, ...] = (*World.subscribes, UNIQUE, IMPACT, IMPACT_ANSWER)

    def __init__(self, host: Host) -> None:
        self.world = World()
        self._host = host
        self._found: dict[int, Context | CratousError] = {}
        self._told: list[int] = []
        self._overridden: dict[int, Any] = {}  # requests with conditions of their own, unanswered

    def start(self) -> Any:
        return self.world.start()

    def handle(self, state: Any, envelope: Envelope, now_ms: int) -> tuple[Any, Iterable[Any]]:
        if envelope.topic == UNIQUE:
            self.open(envelope.body, f"message {envelope.seq}")
            return state, ()
        if envelope.topic == IMPACT:
            if envelope.body.OverridePlanningConditions:
                kept = {**self._overridden, envelope.body.RequestID: envelope.body.TrialRequest}
                self._overridden = dict(list(kept.items())[-MOST_OVERRIDDEN:])
            return state, ()
        if envelope.topic == IMPACT_ANSWER:
            self._overridden.pop(envelope.body.ResponseID, None)
            return state, ()
        return self.world.handle(state, envelope, now_ms)

    def open(self, request: Any, where: str) -> Context | CratousError:
        """What a request means with what is known now; an error if it means nothing."""
        found = self._found.get(request.RequestID)
        if isinstance(found, Context) and found.request == request:
            return found
        try:
            made: Context | CratousError = self._context(request, where)
        except CratousError as error:
            made = error
        self._found.pop(request.RequestID, None)
        self._told = [number for number in self._told if number != request.RequestID]
        self._found[request.RequestID] = made
        while len(self._found) > KEPT:
            self._found.pop(next(iter(self._found)))
        return made

    def put(self, request: Any, inputs: Inputs, desk: RequestDesk) -> None:
        """A request that is about to be published means what was found for it."""
        self._found[request.RequestID] = Context(request, inputs, desk)

    def of(self, request_id: int) -> Context:
        """The context of a request; BadInput if it is unknown, or what is wrong with it."""
        found = self._found.get(request_id)
        if found is None:
            raise BadInput(
                "no such request is being planned here",
                item="RequestID",
                expected=", ".join(map(str, self._found)) or "none is",
                got=str(request_id),
            )
        if isinstance(found, CratousError):
            raise found
        return found

    def serves(self, name: str) -> bool:
        """True if a service of this name is on the same bus."""
        return name in self._host.bus.names()

    def refused(self, request_id: int) -> bool:
        """True if a request means nothing that could be planned."""
        return isinstance(self._found.get(request_id), CratousError)

    def reasons(self, request_id: int) -> tuple[str, ...]:
        """Why a refused request cannot be planned; the first time only, so that it is said once."""
        found = self._found.get(request_id)
        if not isinstance(found, CratousError) or request_id in self._told:
            return ()
        self._told = [*self._told, request_id][-KEPT:]
        return reasons_of(found)

    def for_routes(self, region: int, vehicle: int) -> tuple[RequestDesk, Mission]:
        """The frame, zones and vehicles for routes of a vehicle in a region.

        Those of the newest request that has both; else as the world is now. BadInput if unknown.
        """
        for found in reversed(self._found.values()):
            if (
                isinstance(found, Context)
                and found.region == region
                and vehicle in found.inputs.vehicle_index
            ):
                return found.desk, found.inputs.mission
        return self._surroundings([vehicle], region, ())

    def surroundings(self, vehicle: int, zones: list[int]) -> tuple[RequestDesk, Mission]:
        """The frame and some zones, whatever region they are of. BadInput if one is unknown."""
        extra = lmcp.new("OperatingRegion", ID=_OF_ZONES, KeepOutAreas=zones)
        return self._surroundings([vehicle], _OF_ZONES, (Sent(extra, "zones", 0),))

    def _surroundings(
        self, vehicles: list[int], region: int, more: tuple[Sent, ...]
    ) -> tuple[RequestDesk, Mission]:
        body = lmcp.new("AutomationRequest", EntityList=vehicles, OperatingRegion=region)
        cfg = self._configuration(Sent(body, f"routes of vehicle {vehicles[0]}", 0))
        mission = surroundings_of(
            replace(cfg, messages=(*more, *cfg.messages)), str(self._host.config)
        )
        return RequestDesk(mission), mission

    def mission(self, request: Any, where: str) -> Mission:
        """An AutomationRequest as a mission; BadInput says what is wrong with it."""
        cfg = self._configuration(Sent(request, where, 0))
        return mission_of(cfg, str(self._host.config))

    def _configuration(self, sent: Sent) -> Any:
        root = {k: str(v) for k, v in self._host.root.items() if v}
        services = self._host.shared.get("services", ())
        return self.world.configuration(self._host.config, root, services, sent)

    def _context(self, request: Any, where: str) -> Context:
        # which of two equal requests it is cannot be told: neither is planned as the other
        if any(body == request.OriginalRequest for body in self._overridden.values()):
            raise BadInput(
                "OverridePlanningConditions are not covered",
                where=where,
                item="ImpactAutomationRequest",
                expected="speeds and altitudes in the configurations",
            )
        mission = self.mission(request.OriginalRequest, where)
        for note in mission.notes:
            self._host.log("INFO", f"request {request.RequestID}: {note}")
        desk = RequestDesk(mission)
        given = {
            state.EntityID: desk.pose(
                state.PlanningPosition, state.PlanningHeading, where, f"PlanningStates[{k}]"
            )
            for k, state in enumerate(request.PlanningStates)
        }
        poses = stages.start_poses(mission, given)
        poses = {vehicle.id: poses[vehicle.id] for vehicle in mission.vehicles}
        inputs = Inputs(mission, poses, (), 0)
        for known in self._found.values():
            # the same request again: what was computed for it holds
            if isinstance(known, Context) and known.inputs == inputs:
                inputs, desk = known.inputs, known.desk
                break
        stages.check_starts(mission, poses, inputs.zones)
        if not inputs.wanted:
            raise NoPlan(("no branch of the relations has a task",))
        return Context(request, inputs, desk)


def reasons_of(error: CratousError) -> tuple[str, ...]:
    """An error in the user's terms, one reason each."""
    if isinstance(error, NoPlan):
        return tuple(error.reasons)
    problems = getattr(error, "problems", (error,))
    return tuple(str(problem) for problem in problems)
