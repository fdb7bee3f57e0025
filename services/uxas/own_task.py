"""Base class for user-defined task types: all bus messages, except the flight options
(docs/guides/own-task.md).

It publishes TaskInitialized for each task that it knows, TaskPlanOptions for each request with one,
asks the route planner for the transit route, and answers with the waypoints. TaskActive and
TaskComplete follow the vehicles' AssociatedTasks. An exception or an invalid result of the user's
code ends the request with the reason.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.following.task_parameters import within
from cratous.services.pipeline.mission_end import MISSION
from cratous.services.pipeline.off_plan import (
    ALONE,
    AUTHORITY,
    HANDED_BACK,
    WITH_UXAS,
    away_after,
    on_its_way,
)
from cratous.services.pipeline.passing import Passing, passing_of
from cratous.services.pipeline.status import status
from cratous.spec.errors import BadInput

TASK, CONFIGURATION = "afrl.cmasi.Task", "afrl.cmasi.EntityConfiguration"
STATE, REMOVE = "afrl.cmasi.EntityState", "afrl.cmasi.RemoveTasks"
UNIQUE = "uxas.messages.task.UniqueAutomationRequest"
CHOICE = "uxas.messages.task.TaskImplementationRequest"
ROUTES = "uxas.messages.route.RoutePlanResponse"
PLANS = "afrl.cmasi.AutomationResponse"
ROUTES_FROM = 10**15
"""First id of these services' route requests, above those of other tasks."""
REMEMBERED = 256
"""Number of stored offers and route requests; the oldest are dropped."""
WAYS_MOST, PLACES_MOST, TAKES_MOST_S = 1_000, 10_000, 1e6


class Place(NamedTuple):
    """A place [degrees] with altitude [m MSL]; 0: the vehicle's own."""

    latitude: float
    longitude: float
    altitude_m: float = 0.0


class Flight(NamedTuple):
    """One way to fly a task: its places in order, its duration [s], and the headings at its ends [degrees]."""

    places: Sequence[Place]
    takes_s: float
    start_deg: float = 0.0
    end_deg: float = 0.0


class Held(NamedTuple):
    """tasks and nominal speeds [m/s] by id; offers: by request and task, vehicle and flight of each
    option; asked: by route request id; active: vehicles by task; away: vehicles that ICAROUS
    commands, or has handed back and that do not fly waypoints yet, with which of the two;
    commands: the one that each vehicle reported last; passing: vehicle and place in its plan of
    each task that has not begun.
    """

    tasks: Mapping[int, Any] = MappingProxyType({})
    speeds: Mapping[int, float] = MappingProxyType({})
    offers: Mapping[tuple[int, int], tuple[tuple[int, Flight], ...]] = MappingProxyType({})
    asked: Mapping[int, Any] = MappingProxyType({})
    active: Mapping[int, int] = MappingProxyType({})
    away: Mapping[int, int] = MappingProxyType({})
    commands: Mapping[int, int] = MappingProxyType({})
    passing: Mapping[int, tuple[int, Passing]] = MappingProxyType({})


Step = tuple[Held, Iterable[Any]]


class OwnTask:
    """One task type: every cmasi Task with the Label `label`, flown as `flights` returns."""

    label = ""
    subscribes: tuple[str, ...] = (
        TASK, CONFIGURATION, STATE, REMOVE, UNIQUE, CHOICE, ROUTES, PLANS, MISSION, AUTHORITY, ALONE,
    )  # fmt: skip

    def __init__(self, name: str, values: Mapping[str, Any]) -> None:
        """values: the attributes of the service. BadInput if the class has no label or no `flights`."""
        self.check_class()
        self.name, self.values = name, values

    @classmethod
    def check_class(cls) -> None:
        """BadInput, with the class's name, if it has no label or does not define `flights`."""
        where = f"{cls.__module__}:{cls.__qualname__}"
        if not isinstance(cls.label, str) or not cls.label.strip():
            raise BadInput(
                "the task kind has no label", where=where, item="label",
                expected="the Label of its tasks, a text that is not empty", got=repr(cls.label),
            )  # fmt: skip
        if cls.flights is OwnTask.flights or not callable(cls.flights):
            raise BadInput(
                "the task kind says no flights", where=where, item="flights",
                expected="a method flights(self, task, speed_m_s)", got="none",
            )  # fmt: skip

    def flights(self, task: Any, speed_m_s: float) -> Sequence[Flight]:
        """The ways in which a vehicle with this nominal speed may fly a task; empty if it cannot."""
        raise NotImplementedError

    def start(self) -> Held:
        return Held()

    def handle(self, state: Held, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        if topic == UNIQUE:
            return self._offered(state, body)
        if topic == CHOICE and body.TaskID in state.tasks:
            return self._way_there(state, body)
        if topic == ROUTES and body.ResponseID in state.asked:
            return self._implemented(state, body)
        if topic == PLANS:
            return self._planned(state, body)
        if topic == MISSION:
            return (state, ()) if body.WaypointList else self._over(state, body.VehicleID)
        if topic == REMOVE:
            gone = {*body.TaskList}
            left = {number: task for number, task in state.tasks.items() if number not in gone}
            active = {number: of for number, of in state.active.items() if number not in gone}
            passing = {number: at for number, at in state.passing.items() if number not in gone}
            return state._replace(tasks=left, active=active, passing=passing), ()
        if topic in (AUTHORITY, ALONE):
            away = away_after(state.away.get(body.VehicleID, WITH_UXAS), topic, body)
            return state._replace(away={**state.away, body.VehicleID: away}), ()
        if hasattr(body, "AssociatedTasks"):
            return self._flown(state, body)
        if hasattr(body, "NominalSpeed"):
            return state._replace(speeds={**state.speeds, body.ID: body.NominalSpeed}), ()
        if getattr(body, "Label", "") != self.label or not hasattr(body, "TaskID"):
            return state, ()
        tasks = {**state.tasks, body.TaskID: body}
        return state._replace(tasks=tasks), [lmcp.new("TaskInitialized", TaskID=body.TaskID)]

    def _offered(self, state: Held, body: Any) -> Step:
        out = list[Any]()
        for number in body.OriginalRequest.TaskList:
            task = state.tasks.get(number)
            if task is None:
                continue
            try:
                found = self._found(state, task, body.OriginalRequest.EntityList)
                out.append(_options(body.RequestID, number, found))
            except Exception as error:
                out.append(_failed(body.RequestID, number, error))
                continue
            offers = {**state.offers, (body.RequestID, number): found}
            state = state._replace(offers=_newest(offers))
        return state, out

    def _found(
        self, state: Held, task: Any, asked: Sequence[int]
    ) -> tuple[tuple[int, Flight], ...]:
        """The flights on offer, each with its vehicle."""
        may = task.EligibleEntities or asked or sorted(state.speeds)
        found, where = list[tuple[int, Flight]](), f"task {task.TaskID} ({self.label})"
        for vehicle in may:
            if vehicle not in state.speeds or (asked and vehicle not in asked):
                continue
            flights = self.flights(task, state.speeds[vehicle])
            for k, flight in enumerate(flights):
                within(len(flight.places), 1, PLACES_MOST, where, f"flights[{k}].places")
                within(flight.takes_s, 0.0, TAKES_MOST_S, where, f"flights[{k}].takes_s")
                found.append((vehicle, flight))
        within(len(found), 0, WAYS_MOST, where, "flights")
        return tuple(found)

    def _way_there(self, state: Held, body: Any) -> Step:
        offer = state.offers.get((body.CorrespondingAutomationRequestID, body.TaskID), ())
        chosen = dict(enumerate(offer, 1)).get(body.OptionID)
        if chosen is None or chosen[0] != body.VehicleID:
            error = LookupError(
                f"no option {body.OptionID} of vehicle {body.VehicleID} was offered"
            )
            return state, [_failed(body.CorrespondingAutomationRequestID, body.TaskID, error)]
        number, flight = ROUTES_FROM + body.RequestID, chosen[1]
        route = lmcp.new(
            "RouteConstraints", RouteID=1, StartLocation=body.StartPosition, StartHeading=body.StartHeading,
            EndLocation=_location(flight.places[0]), EndHeading=flight.start_deg,
        )  # fmt: skip
        asked = _newest({**state.asked, number: (body, flight)})
        return state._replace(asked=asked), [
            lmcp.new(
                "RoutePlanRequest", RequestID=number, AssociatedTaskID=body.TaskID, VehicleID=body.VehicleID,
                OperatingRegion=body.RegionID, RouteRequests=[route], IsCostOnlyRequest=False,
            )
        ]  # fmt: skip

    def _implemented(self, state: Held, body: Any) -> Step:
        asked, flight = state.asked[body.ResponseID]
        left = {number: one for number, one in state.asked.items() if number != body.ResponseID}
        state, request = state._replace(asked=left), asked.CorrespondingAutomationRequestID
        try:
            return state, [_plan(asked, flight, body)]
        except Exception as error:
            return state, [_failed(request, asked.TaskID, error)]

    def _over(self, state: Held, vehicle: int) -> Step:
        """The mission of a vehicle is over: its tasks end undone."""
        passing = {n: at for n, at in state.passing.items() if at[0] != vehicle}
        undone = [number for number, by in state.active.items() if by == vehicle]
        active = {number: by for number, by in state.active.items() if by != vehicle}
        return state._replace(active=active, passing=passing), [_undone(n) for n in undone]

    def _planned(self, state: Held, response: Any) -> Step:
        """The place of each task in the vehicles' new plans; a mission that ends ends its tasks undone."""
        out = list[Any]()
        for command in response.MissionCommandList:
            if not command.WaypointList:
                state, more = self._over(state, command.VehicleID)
                out += more
        vehicles = {command.VehicleID for command in response.MissionCommandList}
        passing = {n: at for n, at in state.passing.items() if at[0] not in vehicles}
        for command in response.MissionCommandList:
            vehicle = command.VehicleID
            for number in state.tasks.keys() - state.active.keys():
                found = passing_of(command, number, state.commands.get(vehicle))
                if found is not None:
                    passing[number] = (vehicle, found)
        return state._replace(passing=passing), out

    def _flown(self, state: Held, body: Any) -> Step:
        """Active from the first vehicle state that lists a task, complete with the first that no
        longer does; states from a takeover by ICAROUS until waypoints are flown again end no task.
        """
        command = getattr(body, "CurrentCommand", 0)
        if body.ID in state.speeds and state.commands.get(body.ID) != command:
            commands = _newest({**state.commands, body.ID: command})
            state = state._replace(commands=commands)
        if state.away.get(body.ID) == HANDED_BACK and on_its_way(body):
            left = {number: at for number, at in state.away.items() if number != body.ID}
            state = state._replace(away=left)
        if state.away.get(body.ID, WITH_UXAS) != WITH_UXAS:
            return state, ()
        out, active, listed = list[Any](), dict(state.active), {*body.AssociatedTasks}
        passing = dict(state.passing)
        for number, (vehicle, at) in state.passing.items():
            if vehicle != body.ID or number in active:
                continue
            passing[number] = (vehicle, at.after(body)[0])
            if number in listed or at.after(body)[1]:
                del passing[number]
                listed.add(number)
        for number in sorted(listed & state.tasks.keys() - active.keys()):
            active[number] = body.ID
            of = {"TaskID": number, "EntityID": body.ID}
            out.append(lmcp.new("TaskActive", TimeTaskActivated=body.Time, **of))
        for number, vehicle in list(active.items()):
            if vehicle == body.ID and number not in body.AssociatedTasks:
                del active[number]
                of = {"TaskID": number, "EntitiesInvolved": [vehicle]}
                out.append(lmcp.new("TaskComplete", TimeTaskCompleted=body.Time, **of))
        return state._replace(active=active, passing=passing), out


def _newest(held: dict[Any, Any]) -> dict[Any, Any]:
    return dict(list(held.items())[-REMEMBERED:])


def _location(place: Place) -> Any:
    lat, lon, alt = Place(*place)
    return lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=alt)


def _options(request: int, task: int, found: Sequence[tuple[int, Flight]]) -> Any:
    options = [
        lmcp.new(
            "TaskOption", TaskID=task, OptionID=number, EligibleEntities=[vehicle], Cost=round(1000 * flight.takes_s),
            StartLocation=_location(flight.places[0]), StartHeading=flight.start_deg,
            EndLocation=_location(flight.places[-1]), EndHeading=flight.end_deg,
        )
        for number, (vehicle, flight) in enumerate(found, 1)
    ]  # fmt: skip
    names = " ".join(f"p{option.OptionID}" for option in options)
    return lmcp.new(
        "TaskPlanOptions", CorrespondingAutomationRequestID=request, TaskID=task,
        Composition=f"+({names})" if names else "", Options=options,
    )  # fmt: skip


def _plan(asked: Any, flight: Flight, response: Any) -> Any:
    """The waypoints of the transit and of the flight, at the transit's speed and, where a place has
    none, its altitude.
    """
    route = response.RouteResponses[0]
    if not route.Waypoints:
        why = "; ".join(pair.Value for pair in route.RouteError) or "the planner does not say why"
        raise LookupError(f"vehicle {asked.VehicleID} has no way there: {why}")
    wait = max(0, asked.TimeThreshold - asked.StartTime - route.RouteCost)
    if wait:
        raise LookupError(f"vehicle {asked.VehicleID} would have to wait {wait / 1000:g} s for it")
    *way, last = route.Waypoints
    for place in flight.places:
        lat, lon, alt = Place(*place)
        of = {"Latitude": lat, "Longitude": lon, "Altitude": alt or last.Altitude}
        way.append(last.copy(**of, AssociatedTasks=[asked.TaskID]))
    first = asked.StartingWaypointID
    points = [w.copy(Number=first + k, NextWaypoint=first + k + 1) for k, w in enumerate(way)]
    return lmcp.new(
        "TaskImplementationResponse", ResponseID=asked.RequestID, TaskID=asked.TaskID,
        CorrespondingAutomationRequestID=asked.CorrespondingAutomationRequestID,
        OptionID=asked.OptionID, VehicleID=asked.VehicleID, TaskWaypoints=points,
        FinalTime=asked.StartTime + route.RouteCost + round(1000 * flight.takes_s),
        FinalLocation=_location(flight.places[-1]), FinalHeading=flight.end_deg,
    )  # fmt: skip


def _failed(request: int, task: int, error: Exception) -> Any:
    text = f"task {task}: {type(error).__name__}: {error}"
    return status(request, "Error", [("TaskID", str(task)), ("reason", text)])


def _undone(task: int) -> Any:
    text = f"task {task} ends undone: its vehicle's mission has ended"
    return status(0, "Warning", [("TaskID", str(task)), ("reason", text)])
