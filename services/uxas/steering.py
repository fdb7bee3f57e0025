"""SteeringService: flies a plan for an aircraft whose autopilot accepts courses but no waypoints.

AirVehicleState at the address PartialAirVehicleState (set by a bridge's TransformReceivedMessage)
-> a VehicleActionCommand with heading, speed and altitude, or a SafeHeadingAction for the
LoiterLeash; and the same state with the current waypoint and its tasks. The plan is that of the
newest AutomationResponse or MissionCommand. It is silent while a task steers with
FlightDirectorActions of its own.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees, dist, isfinite, pi, radians, tan
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.kernel import Vec2
from cratous.services.bus import Envelope
from cratous.services.loading.uxas_parts import is_place
from cratous.services.loading.uxas_settings import flag, number, whole
from cratous.services.uxas.courses import circle_course, line_course, passed, plane

PARTIAL = "PartialAirVehicleState"
CONFIGURATION = "afrl.cmasi.AirVehicleConfiguration"
RESPONSE, COMMAND = "afrl.cmasi.AutomationResponse", "afrl.cmasi.MissionCommand"
ACTIONS = "afrl.cmasi.VehicleActionCommand"
SPEED = "uxas.messages.uxnative.SpeedOverrideAction"
ASKED, ANSWERED = (
    "uxas.messages.task.UniqueAutomationRequest",
    "uxas.messages.task.UniqueAutomationResponse",
)
GRAVITY_M_S2 = 9.80665
SAME_M = 1.0
"""A leg shorter than this counts as flown [m]."""
REGIONS_MOST = 64
WIDER, AHEAD = 1.2, 3.0
"""Leash loiters: radius as a multiple of the minimum turn radius, and distance ahead as a multiple
of that radius.
"""

Place = tuple[float, float]


class Steering(NamedTuple):
    """Guidance parameters; accept_ms: a waypoint counts as reached this time ahead [ms]; most_rad,
    per_m: of lines; gain: of circles; leash: courses are sent as SafeHeadingActions; region: for
    these, None: the plan's.
    """

    accept_ms: int = 0
    most_rad: float = pi / 2
    per_m: float = 0.01
    gain: float = 1.0
    leash: bool = False
    region: int | None = None


ATTRIBUTES = {
    "VehicleID": whole(-1, -1),
    "AcceptanceTime_ms": whole(0),
    "UseSafeHeadingAction": flag(False),
    "OverrideRegion": whole(None),
    "MaxCourseAngleDeg": number(90.0, 1.0, 90.0),
    "KLine": number(0.01, 1e-6, 1e6),
    "KOrbit": number(1.0, 1e-6, 1e6),
}


def steering_of(v: dict[str, Any]) -> Steering:
    """The parameters in a configuration."""
    return Steering(
        v["AcceptanceTime_ms"],
        radians(v["MaxCourseAngleDeg"]),
        v["KLine"],
        v["KOrbit"],
        v["UseSafeHeadingAction"],
        v["OverrideRegion"],
    )


class Steered(NamedTuple):
    """The plan and its current waypoint, since when [ms]; start of the leg to it; done: it was the
    last; told_m_s: commanded speed in place of the waypoints'; by_task: a task steers; number of
    commands; the aircraft's configuration; the region of the plan, and those of pending requests.
    """

    plan: Any = None
    number: int = 0
    since_ms: int = 0
    begin: Place | None = None
    done: bool = False
    told_m_s: float | None = None
    by_task: bool = False
    commands: int = 0
    configuration: Any = None
    region: int = 0
    regions: tuple[tuple[int, int], ...] = ()

    def waypoint(self, number: int) -> Any:
        """A waypoint of the plan; None if there is none with this number."""
        points = () if self.plan is None else self.plan.WaypointList
        return next((w for w in points if w.Number == number), None)


Step = tuple[Steered, Iterable[Any]]


class SteeringService:
    """Steering of one aircraft."""

    subscribes: tuple[str, ...] = (
        PARTIAL, CONFIGURATION, RESPONSE, COMMAND, ACTIONS, SPEED, ASKED, ANSWERED
    )  # fmt: skip

    def __init__(self, name: str, vehicle: int, steering: Steering) -> None:
        self.name, self._vehicle, self._how = name, vehicle, steering

    def start(self) -> Steered:
        return Steered()

    def handle(self, state: Steered, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        if topic == "afrl.cmasi.AirVehicleState":
            return self._flown(state, body, now_ms) if self._vehicle == body.ID else (state, ())
        if topic in (ASKED, ANSWERED):
            return self._planned(state, body, topic == ASKED), ()
        if topic == RESPONSE:
            mine = [c for c in body.MissionCommandList if c.VehicleID == self._vehicle]
            return (_begun(state, mine[0], now_ms) if mine else state), ()
        if topic == CONFIGURATION:
            return (state._replace(configuration=body) if self._vehicle == body.ID else state), ()
        if body.VehicleID != self._vehicle:
            return state, ()
        if topic == COMMAND:
            return _begun(state, body, now_ms), ()
        if topic == SPEED:
            return state._replace(told_m_s=body.Speed), ()
        kinds = {type(action).__name__ for action in body.VehicleActionList}
        return state._replace(by_task=state.by_task or "FlightDirectorAction" in kinds), ()

    def _planned(self, state: Steered, body: Any, asked: bool) -> Steered:
        """Note the region of a request as that of its plan, if this aircraft takes part; trial
        plans are not flown.
        """
        if asked:
            if body.SandBoxRequest or body.OriginalRequest is None:
                return state
            one = (body.RequestID, body.OriginalRequest.OperatingRegion)
            return state._replace(regions=(*state.regions, one)[-REGIONS_MOST:])
        plans = body.OriginalResponse.MissionCommandList if body.OriginalResponse else ()
        mine = any(command.VehicleID == self._vehicle for command in plans)
        region = dict(state.regions).get(body.ResponseID, state.region) if mine else state.region
        left = tuple(one for one in state.regions if one[0] != body.ResponseID)
        return state._replace(region=region, regions=left)

    def _flown(self, state: Steered, body: Any, now_ms: int) -> Step:
        """Compute the course from here, and publish the state to all."""
        out: list[Any] = []
        place = body.Location
        known = place is not None and is_place(place.Latitude, place.Longitude)
        if known and state.waypoint(state.number) is not None:
            here = (place.Latitude, place.Longitude)
            state = self._on(state._replace(begin=state.begin or here), here, now_ms)
            if not state.by_task:
                state, out = self._steer(state, here)
        waypoint = state.waypoint(state.number)
        tasks = [] if waypoint is None else list(waypoint.AssociatedTasks)
        return state, [*out, body.copy(CurrentWaypoint=state.number, AssociatedTasks=tasks)]

    def _on(self, state: Steered, here: Place, now_ms: int) -> Steered:
        """Advance while a waypoint is reached, each at most once, so that a cycle of close waypoints terminates."""
        reached: set[int] = set()
        while not state.done and self._reached(state, here, now_ms):
            waypoint = state.waypoint(state.number)
            if state.number in reached:
                return state._replace(done=True)
            reached.add(state.number)
            state = state._replace(begin=(waypoint.Latitude, waypoint.Longitude))
            number = waypoint.NextWaypoint
            if number == state.number or state.waypoint(number) is None:
                return state._replace(done=True)
            state = state._replace(number=number, since_ms=now_ms)
        return state

    def _reached(self, state: Steered, here: Place, now_ms: int) -> bool:
        waypoint = state.waypoint(state.number)
        loiter = _loiter(waypoint)
        if loiter is not None:
            return bool(0 <= loiter.Duration <= now_ms - state.since_ms)
        to = (waypoint.Latitude, waypoint.Longitude)
        at, before, end = plane(*here, to), plane(*(state.begin or here), to), Vec2(0.0, 0.0)
        if passed(at, before, end):
            return True
        near_m = self._how.accept_ms / 1000 * _speed(state.configuration)
        short = waypoint.TurnType.name == "TurnShort" and dist(at, end) <= near_m
        return short or dist(before, end) <= SAME_M

    def _steer(self, state: Steered, here: Place) -> tuple[Steered, list[Any]]:
        waypoint, how = state.waypoint(state.number), self._how
        loiter, of = _loiter(waypoint), (waypoint.Latitude, waypoint.Longitude)
        speed, kind = waypoint.Speed, waypoint.SpeedType
        if loiter is not None:
            if loiter.Location is not None and is_place(
                loiter.Location.Latitude, loiter.Location.Longitude
            ):
                of = (loiter.Location.Latitude, loiter.Location.Longitude)
            clockwise = loiter.Direction.name != "CounterClockwise"
            radius = max(loiter.Radius, 1.0)
            course = circle_course(plane(*here, of), Vec2(0.0, 0.0), radius, clockwise, how.gain)
            speed, kind = loiter.Airspeed, "Airspeed"
        else:
            at = plane(*here, of)
            begin = at if state.done or state.begin is None else plane(*state.begin, of)
            course = line_course(at, begin, Vec2(0.0, 0.0), how.most_rad, how.per_m)
        if state.told_m_s is not None:
            speed = state.told_m_s
        common = {
            "Speed": speed, "Altitude": waypoint.Altitude, "AltitudeType": waypoint.AltitudeType
        }  # fmt: skip
        heading = (degrees(course) + 180.0) % 360.0 - 180.0
        if how.leash:
            radius = WIDER * _turn_m(state.configuration)
            region = state.region if how.region is None else how.region
            action = lmcp.new(
                "SafeHeadingAction",
                VehicleID=self._vehicle,
                OperatingRegion=region,
                LeadAheadDistance=AHEAD * radius or 1000.0,
                LoiterRadius=radius,
                DesiredHeading=heading,
                UseAltitude=True,
                UseSpeed=True,
                **common,
            )
            return state, [action]
        action = lmcp.new(
            "FlightDirectorAction",
            Heading=heading,
            SpeedType=kind,
            ClimbRate=waypoint.ClimbRate,
            **common,
        )
        command = lmcp.new(
            "VehicleActionCommand",
            CommandID=state.commands + 1,
            VehicleID=self._vehicle,
            VehicleActionList=[action],
            Status="Approved",
        )
        return state._replace(commands=state.commands + 1), [command]


def _begun(state: Steered, plan: Any, now_ms: int) -> Steered:
    """Start a plan at its first waypoint; the leg to it begins at the waypoint that leads to it, if
    there is one.

    A plan with invalid waypoint links is rejected: the previous one is flown on.
    """
    if not all(map(_leads, plan.WaypointList)):
        return state
    first = plan.FirstWaypoint
    before = next((w for w in plan.WaypointList if w.NextWaypoint == first != w.Number), None)
    begin = None if before is None else (before.Latitude, before.Longitude)
    return state._replace(
        plan=plan,
        number=first,
        since_ms=now_ms,
        begin=begin,
        done=len(plan.WaypointList) == 1,
        told_m_s=None,
        by_task=False,
    )


def _leads(waypoint: Any) -> bool:
    """Whether a waypoint gives a valid course, speed and altitude."""
    loiter = _loiter(waypoint)
    numbers = [waypoint.Speed, waypoint.Altitude, waypoint.ClimbRate]
    numbers += [] if loiter is None else [loiter.Radius, loiter.Airspeed]
    return is_place(waypoint.Latitude, waypoint.Longitude) and all(map(isfinite, numbers))


def _loiter(waypoint: Any) -> Any:
    """The first loiter at a waypoint, None if there is none."""
    actions = waypoint.VehicleActionList
    return next((a for a in actions if type(a).__name__ == "LoiterAction"), None)


def _speed(configuration: Any) -> float:
    return 0.0 if configuration is None else float(configuration.NominalSpeed)


def _turn_m(configuration: Any) -> float:
    """Minimum turn radius at nominal speed [m], 0 if unknown."""
    profile = getattr(configuration, "NominalFlightProfile", None)
    bank = abs(profile.MaxBankAngle) if profile is not None else 0.0
    return (
        _speed(configuration) ** 2 / (GRAVITY_M_S2 * tan(radians(bank))) if 0 < bank < 90 else 0.0
    )
