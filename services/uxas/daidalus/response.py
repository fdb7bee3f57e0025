"""DAIDALUS_WCV_Response: resolves predicted losses of well clear, and returns to the mission afterwards.

WellClearViolationIntervals and DAIDALUSConfiguration of the vehicle, its states and missions, and zones ->
VehicleActionCommand (a FlightDirectorAction), MissionCommand (back to the mission) and ServiceStatus (each change,
with the reason). The states are those of `spec.contracts.responses`; `response_step` decides what to do, from facts
that kernels decide. A manoeuvre is renewed when it is no longer valid, or when another commander has intervened.

Right of way: the lower id has it, but only before a vehicle known to resolve conflicts itself, because its intervals
are received; and not once the loss is nearer than `RightOfWayLimit`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.authority.gate import gives_way
from cratous.core.authority.right_of_way import must_act
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.avoidance.manoeuvre import Ability
from cratous.core.contracts.responses import Response, loss_is_soon, response_step
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.services.bus import Envelope
from cratous.services.uxas.daidalus.manoeuvre_selection import (
    RESUME_REGIONS,
    Flight,
    Found,
    Manoeuvre,
    bands,
    blocked,
    divert,
    made,
    path,
    still_good,
)
from cratous.services.uxas.daidalus.parameters import turn_rate_deg_s
from cratous.services.uxas.daidalus.states import air_vector, wind_of
from cratous.services.uxas.daidalus.zones import Surroundings, frame_at, surroundings
from cratous.spec.contracts.responses import (
    DIVERT,
    HOLD,
    REFUSE,
    RESUME,
    RIGHT_OF_WAY,
    SEND_BACK,
    STATES,
)
from cratous.spec.daa.parameters import G_M_S2

PLAN, COMMAND = "afrl.cmasi.AutomationResponse", "afrl.cmasi.MissionCommand"
STATE, CONFIGURED = "afrl.cmasi.AirVehicleState", "afrl.cmasi.AirVehicleConfiguration"
INTERVALS = "larcfm.DAIDALUS.WellClearViolationIntervals"
PARAMETERS = "larcfm.DAIDALUS.DAIDALUSConfiguration"
KEEP_IN, KEEP_OUT = "afrl.cmasi.KeepInZone", "afrl.cmasi.KeepOutZone"
REMOVE_ZONES = "afrl.cmasi.RemoveZones"

FREE_MS = 2000
"""Time for which the return path must have been clear [ms]."""
AGAIN_MS = 5000
"""Time after which a return command without effect is repeated [ms]."""
HEARD_MS = 5000
"""A vehicle whose intervals were received within this time resolves conflicts itself [ms]."""
STANDARD_TURN_DEG_S = 3.0
STANDARD_ACCELERATION_M_S2 = 2.0
STANDARD_CLIMB_M_S = 2.54


class Answering(NamedTuple):
    """State of the service: response; messages about the vehicle; zones by id, and as geometry; next waypoint;
    manoeuvre being flown (None: to be commanded again); time since which the return path is clear, and of the return
    command; intruders being resolved; when each vehicle was last heard; number of commands; last status."""

    response: Response = Response(0, False)
    parameters: Any = None
    configuration: Any = None
    own: Any = None
    mission: Any = None
    zones: Mapping[int, Any] = {}
    around: Surroundings = Surroundings()
    waypoint: int = 0
    flown: Manoeuvre | None = None
    free_ms: int | None = None
    sent_ms: int = 0
    answered: frozenset[int] = frozenset()
    heard: Mapping[int, int] = {}
    commands: int = 0
    said: str = f"Information{STATES[0]}"


Step = tuple[Answering, Iterable[Any]]


class DaidalusResponse:
    """Conflict resolution for one vehicle."""

    subscribes: tuple[str, ...] = (
        PLAN,
        COMMAND,
        STATE,
        CONFIGURED,
        INTERVALS,
        PARAMETERS,
        KEEP_IN,
        KEEP_OUT,
        REMOVE_ZONES,
    )

    def __init__(self, name: str, vehicle: int, kind: str, limit: float | None) -> None:
        """kind: of manoeuvres (`diverts.KINDS`); limit: least time to a loss at which right of way is used [s], None:
        half of the alerting time."""
        self.name, self._vehicle, self._kind, self._limit = name, vehicle, kind, limit

    def start(self) -> Answering:
        return Answering()

    def handle(self, state: Answering, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        if topic == INTERVALS:
            if body.EntityId != self._vehicle:
                return state._replace(heard={**state.heard, body.EntityId: now_ms}), ()
            return self._answer(state, body, now_ms)
        if topic in (KEEP_IN, KEEP_OUT):
            return self._zones(state, {**state.zones, body.ZoneID: body}), ()
        if topic == REMOVE_ZONES:
            left = {n: z for n, z in state.zones.items() if n not in body.ZoneList}
            return self._zones(state, left), ()
        if topic == PLAN:
            commands = [c for c in body.MissionCommandList if c.VehicleID == self._vehicle]
            return (self._commanded(state, commands[-1]) if commands else state), ()
        if topic == COMMAND:
            mine = body.VehicleID == self._vehicle and envelope.source != self.name
            return (self._commanded(state, body) if mine else state), ()
        if topic == PARAMETERS:
            return (
                state._replace(parameters=body) if body.EntityId == self._vehicle else state
            ), ()
        if self._vehicle != body.ID:
            return state, ()
        if topic == CONFIGURED:
            return state._replace(configuration=body), ()
        return self._flown(state, body), ()

    @staticmethod
    def _zones(state: Answering, zones: Mapping[int, Any]) -> Answering:
        return state._replace(zones=zones, around=Surroundings())

    @staticmethod
    def _commanded(state: Answering, command: Any) -> Answering:
        """Process a mission, or part of one: it replaces the manoeuvre in the vehicle, which is commanded again."""
        return state._replace(mission=command, flown=None, waypoint=command.FirstWaypoint)

    @staticmethod
    def _flown(state: Answering, own: Any) -> Answering:
        """Process an own state; its waypoint counts only while the vehicle flies its mission."""
        if not state.response.off and _waypoint(state.mission, own.CurrentWaypoint) is not None:
            state = state._replace(waypoint=own.CurrentWaypoint)
        frame = frame_at(own.Location)
        if state.around.frame != frame:
            kind = own.Location.AltitudeType.name
            state = state._replace(around=surroundings(frame, state.zones.values(), kind))
        return state._replace(own=own)

    def _answer(self, state: Answering, message: Any, now_ms: int) -> Step:
        if state.parameters is None or state.own is None:
            lacking = "DAIDALUSConfiguration" if state.parameters is None else "AirVehicleState"
            return self._say(state, "Warning", f"no answer: no {lacking} of it has been heard", [])
        conflicts = self._conflicts(state, message)
        state = state._replace(answered=frozenset(conflicts))
        ours = [n for n, first in conflicts.items() if self._is_ours(state, n, first, now_ms)]
        flight = self._flight(state)
        zones, broken = state.around.binding(flight.position)
        good = state.flown is not None and still_good(
            flight, state.flown, message, zones, not conflicts or bool(ours)
        )
        goal = _waypoint(state.mission, state.waypoint)
        free, why_not = self._way_back(state, flight, goal, message, zones)
        resting = bool(state.response.off and not conflicts and not free)
        found = Found(None)
        if (conflicts and not good) or state.response.off:
            wanted = self._wanted(state, flight, goal if resting else None)
            found = divert(flight, self._kind, wanted, message, state.parameters, zones)
            if resting and good and _better(found, state.flown, wanted):
                good = False
        since = state.free_ms if free and not conflicts else None
        since = now_ms if free and not conflicts and since is None else since
        state = state._replace(free_ms=since)
        long = since is not None and lasted(since, now_ms, FREE_MS)
        if state.response.state == RESUME:
            long = lasted(state.sent_ms, now_ms, AGAIN_MS)
        facts = (bool(conflicts), bool(ours), good, found.manoeuvre is not None, free, long)
        response, act = response_step(state.response, *facts, self._taken(state))
        state = state._replace(response=response)
        reasons = [
            *(_loss(n, first, n in ours) for n, first in conflicts.items()),
            *([why_not] if response.state == HOLD and why_not else []),
            *(found.why if act == REFUSE else ()),
            *(f"{label} is broken already and binds no more" for label in broken),
            *state.around.missing,
        ]
        return self._do(state, act, found, reasons, now_ms)

    def _conflicts(self, state: Answering, message: Any) -> dict[int, float]:
        """Intruders with an imminent predicted loss, and the time to it [s]."""
        p = state.parameters
        pairs = zip(message.EntityList, message.TimeToViolationList, strict=False)
        return {
            number: first
            for number, first in pairs
            if loss_is_soon(first, p.AlertTime3, p.EarlyAlertTime3, number in state.answered)
        }

    def _is_ours(self, state: Answering, intruder: int, first: float, now_ms: int) -> bool:
        heard = state.heard.get(intruder)
        cooperates = heard is not None and in_time(heard, now_ms, HEARD_MS)
        limit = state.parameters.AlertTime3 / 2 if self._limit is None else self._limit
        yields = gives_way(self._vehicle, intruder, cooperates)
        return must_act(first, limit, limit, 0.0, True, False, yields)

    def _flight(self, state: Answering) -> Flight:
        own, p = state.own, state.parameters
        wind = wind_of(own)
        heading, speed = air_vector(own, wind)
        goal = _waypoint(state.mission, state.waypoint)
        turn = turn_rate_deg_s(p, speed) or self._bank_turn(state, speed)
        ability = Ability(
            math.radians(turn),
            p.MinGroundSpeed,
            p.MaxGroundSpeed,
            p.VerticalRate,
            p.HorizontalAcceleration or STANDARD_ACCELERATION_M_S2,
            p.MinAltitude,
        )
        position = state.around.position(own.Location)
        return Flight(
            position,
            heading,
            speed,
            own.VerticalSpeed,
            wind,
            ability,
            position.alt_m if goal is None else goal.Altitude,
            p.VerticalRate or STANDARD_CLIMB_M_S,
        )

    @staticmethod
    def _bank_turn(state: Answering, speed: float) -> float:
        """Turn rate at the maximum bank angle of the vehicle's configuration, otherwise a standard turn."""
        profile = getattr(state.configuration, "NominalFlightProfile", None)
        bank = profile.MaxBankAngle if profile is not None else 0.0
        if not bank or not speed:
            return STANDARD_TURN_DEG_S
        return math.degrees(G_M_S2 * math.tan(math.radians(bank)) / speed)

    def _wanted(self, state: Answering, flight: Flight, goal: Any) -> float:
        """The preferred value of a manoeuvre: the present one; on hold, that of the return path."""
        if self._kind == "Heading":
            return flight.heading if goal is None else _heading_to(state, flight, goal)
        if self._kind == "GroundSpeed":
            return flight.speed if goal is None else float(goal.Speed)
        if self._kind == "VerticalSpeed":
            return flight.climb if goal is None else 0.0
        return flight.position.alt_m if goal is None else float(goal.Altitude)

    def _way_back(
        self, state: Answering, flight: Flight, goal: Any, message: Any, zones: Any
    ) -> tuple[bool, str]:
        """Whether the path to the next waypoint is clear of bands and zones, and if not, why."""
        if not state.response.off:
            return False, ""
        if goal is None:
            return False, "no mission is known to come back to"
        heading = _heading_to(state, flight, goal)
        turn = made(flight, "Heading", heading, RESUME_REGIONS, state.parameters)
        checks = (("Heading", heading), ("GroundSpeed", goal.Speed), ("Altitude", goal.Altitude))
        for kind, value in checks:
            if blocked(kind, value, bands(message, kind), RESUME_REGIONS):
                return False, f"{kind} {value:g}, the way back, lies in a band"
        if zones:
            turning = path(flight, turn, math.pi / flight.ability.turn_rate_rad_s)
            way = [*turning[:-1], state.around.position(goal)]
            bad = first_bad_leg(way, zones)
            if bad is not None:
                return False, f"the way back to waypoint {goal.Number} meets {bad[1].label}"
        return True, ""

    def _taken(self, state: Answering) -> bool:
        """Whether the vehicle reports that it flies to a waypoint of its mission."""
        known = _waypoint(state.mission, state.own.CurrentWaypoint) is not None
        return known and state.own.Mode.name != "FlightDirector"

    def _do(
        self, state: Answering, act: int, found: Found, reasons: list[str], now_ms: int
    ) -> Step:
        out: list[Any] = []
        did = ""
        if act == DIVERT:
            assert found.manoeuvre is not None
            state = state._replace(flown=found.manoeuvre, commands=state.commands + 1)
            out.append(self._action(state, found.manoeuvre))
            did = f"commanded: {found.manoeuvre.text()}"
        elif act == SEND_BACK:
            state = state._replace(flown=None, sent_ms=now_ms, commands=state.commands + 1)
            number = state.commands
            out.append(state.mission.copy(FirstWaypoint=state.waypoint, CommandID=number))
            did = f"sent back to waypoint {state.waypoint}"
        elif act == REFUSE:
            did = "no manoeuvre is free of bands and zones"
        elif state.response.state == RIGHT_OF_WAY:
            did = "left to the others"
        text = "; ".join([STATES[state.response.state], *([did] if did else []), *reasons])
        return self._say(state, "Error" if act == REFUSE else "Information", text, out)

    def _action(self, state: Answering, m: Manoeuvre) -> Any:
        action = lmcp.new(
            "FlightDirectorAction",
            Speed=m.speed,
            SpeedType="Airspeed",
            Heading=m.heading,
            Altitude=m.altitude,
            AltitudeType=state.own.Location.AltitudeType,
            ClimbRate=m.climb,
        )
        return lmcp.new(
            "VehicleActionCommand",
            CommandID=state.commands,
            VehicleID=self._vehicle,
            VehicleActionList=[action],
            Status="Approved",
        )

    def _say(self, state: Answering, kind: str, text: str, out: list[Any]) -> Step:
        """Send a status if it differs from the last one by more than its numbers, or if something is commanded."""
        gist = kind + "".join(c for c in text if not c.isdigit())
        if gist == state.said and not out:
            return state, out
        pairs = (
            ("VehicleID", str(self._vehicle)),
            ("state", STATES[state.response.state]),
            ("reason", text),
        )
        info = [lmcp.new("KeyValuePair", Key=key, Value=value) for key, value in pairs]
        out.append(lmcp.new("ServiceStatus", StatusType=kind, Info=info))
        return state._replace(said=gist), out


def _loss(intruder: int, first: float, ours: bool) -> str:
    whom = "ours to avoid" if ours else "its to avoid"
    return f"loss with vehicle {intruder} in {first:.1f} s, {whom}"


def _waypoint(mission: Any, number: int) -> Any:
    if mission is None:
        return None
    return next((w for w in mission.WaypointList if w.Number == number), None)


def _heading_to(state: Answering, flight: Flight, goal: Any) -> float:
    """Heading that leads to a waypoint over the ground, in the present wind [deg]."""
    there, here = state.around.position(goal), flight.position
    north, east = there.north_m - here.north_m, there.east_m - here.east_m
    track = math.atan2(east, north)
    across = flight.wind.east * math.cos(track) - flight.wind.north * math.sin(track)
    lean = math.asin(max(-1.0, min(1.0, across / flight.speed))) if flight.speed else 0.0
    heading = math.degrees(track - lean) % 360.0
    return 0.0 if heading == 360.0 else heading


def _better(found: Found, flown: Manoeuvre | None, wanted: float) -> bool:
    """Whether a manoeuvre is closer to the wanted value than the one being flown, by a clear margin."""
    if found.manoeuvre is None or flown is None or flown.kind != found.manoeuvre.kind:
        return False
    worst, best = (_apart(m.kind, m.value, wanted) for m in (flown, found.manoeuvre))
    fair = {"Heading": 10.0, "GroundSpeed": 2.0, "VerticalSpeed": 1.0, "Altitude": 30.0}
    return worst - best > fair[flown.kind]


def _apart(kind: str, a: float, b: float) -> float:
    if kind != "Heading":
        return abs(a - b)
    turn = abs(a - b) % 360.0
    return min(turn, 360.0 - turn)
