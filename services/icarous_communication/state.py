"""What UxAS's end of the bridge remembers of vehicles and zones, and what it answers besides lines and messages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any, NamedTuple

from cratous.bridge.text_protocol import (
    Dialect,
    FenceDone,
    FenceVertex,
    ForgetFences,
    ForgetWaypoints,
    GoToWaypoint,
    HardReset,
    Message,
    SoftReset,
    StopMission,
    Waypoint,
)
from cratous.bridge.text_protocol.layouts import ORIGINAL_LIMITS
from cratous.core.authority.timeliness import in_time
from cratous.services.flight import link_end
from cratous.services.flight.dynamics import AirState, turn_radius_m
from cratous.services.flight.link_lines import fence, onward
from cratous.services.flight.link_peers import to_others
from cratous.services.flight.messages import Down, Say
from cratous.services.icarous.ending import TURN_MARGIN
from cratous.services.icarous_communication.doors import Dialects
from cratous.services.icarous_communication.plans import Away, Plan, position_of
from cratous.services.mission.frames import Projection
from cratous.services.uxas.daidalus.zones import surroundings
from cratous.spec.mission import Frame, Position, Zone

TRAFFIC_KEPT_MS = 5000
"""An aircraft whose state is of a time farther than this [ms] from another's is not told to that one."""
SPARE_WAYPOINTS = 10
"""The original's client is told the next part of a plan when it has no more than these ahead."""
SETTLES_MS = 2000
"""After this a vehicle that does not show the first waypoint of a new plan is on a later one [ms]."""
COMMANDS_FROM = 2**40
"""Ids of the commands of this service, apart from those of others."""
MOST_BANK_RAD = math.radians(80.0)
DEFAULT_BANK_RAD = math.radians(30.0)
"""How far a vehicle banks of which no configuration is known, or one that says nothing of it."""


MISSION_OVER = StopMission(), ForgetWaypoints()
"""What an instance is told when the mission of its vehicle is over."""


class Refuse(NamedTuple):
    """To the log: what is not acted upon. why: counted by it; detail: this time."""

    why: str
    detail: str


class Note(NamedTuple):
    """To the log. severity: as a logger's."""

    severity: str
    text: str


Out = Say | Down | Refuse | Note


@dataclass(frozen=True)
class Craft:
    """What is known of one vehicle: its configuration; its newest state and where that is in the plane; its plan; that
    ICAROUS has it; that it was told to hold, because its ICAROUS is not heard; that it was handed back
    just now, so that the last steering of ICAROUS may still come; waiting: the mission that came meanwhile."""

    configuration: Any = None
    body: Any = None
    air: AirState | None = None
    plan: Plan | None = None
    away: Away | None = None
    holds: bool = False
    handed: bool = False
    waiting: Any = None

    @property
    def listed(self) -> tuple[int, ...]:
        """The tasks of its newest state."""
        return () if self.body is None else tuple(self.body.AssociatedTasks)


@dataclass(frozen=True)
class State:
    """link: what the end remembers; frame: the plane, None before anything has a place; zones and crafts
    by id; commands: given so far; fresh: vehicles whose instance has not yet said which epoch it is in; stale: who is not told as traffic;
    client_zones: which of the zones that are told, counted from 1, the original's clients are told."""

    link: link_end.State = field(default_factory=link_end.State)
    frame: Frame | None = None
    zones: Mapping[int, Any] = field(default_factory=dict)
    crafts: Mapping[int, Craft] = field(default_factory=dict)
    commands: int = 0
    fresh: frozenset[int] = frozenset()
    stale: frozenset[int] = frozenset()
    client_zones: tuple[int, ...] = ()

    @property
    def plane(self) -> Projection:
        """The projection of the frame, some other as long as there is none."""
        return plane(self.frame or Frame(0.0, 0.0))

    def craft(self, vehicle_id: int) -> Craft:
        """What is known of a vehicle."""
        return self.crafts.get(vehicle_id, Craft())

    def put(self, vehicle_id: int, craft: Craft) -> State:
        """The same with this of a vehicle."""
        return replace(self, crafts={**self.crafts, vehicle_id: craft})


@lru_cache(maxsize=16)
def plane(frame: Frame) -> Projection:
    """The projection of a frame, made once."""
    return Projection(frame)


def air_state(body: Any, projection: Projection) -> AirState:
    """Where an aircraft is and how it moves, from an AirVehicleState: body axes (u forward, v right,
    w down), or ground speed and course where it says no body axes."""
    heading = math.radians(body.Heading)
    u, v, course = body.u, body.v, math.radians(body.Course)
    north = u * math.cos(heading) - v * math.sin(heading)
    east = u * math.sin(heading) + v * math.cos(heading)
    climb = -body.w
    if not (u or v):
        north, east = body.Groundspeed * math.cos(course), body.Groundspeed * math.sin(course)
        climb = body.VerticalSpeed
    place = position_of(body.Location, projection)
    return AirState(place, math.atan2(east, north), math.hypot(north, east), climb)


def tellable(frame: Frame, bodies: Iterable[Any]) -> tuple[tuple[Zone, ...], list[Note]]:
    """The zones that are sent to peers, and for each other zone why it is not."""
    around = surroundings(frame, bodies, "MSL")
    return around.zones, [Note("WARN", text) for text in around.missing]


def held_by_client(zones: tuple[Zone, ...]) -> tuple[tuple[Zone, ...], list[Note]]:
    """Those of them that the original's client is told, and about the others why not: it publishes a fence for each
    GEOFN_SEND, with whatever it holds of it, and counts them itself."""
    most, corners = ORIGINAL_LIMITS.zones, ORIGINAL_LIMITS.vertices
    fit = tuple(zone for zone in zones if len(zone.vertices) in range(corners + 1))
    alone = "the original's client is not told of it"
    why = [f"zone {z.id}: more than {corners} vertices; {alone}" for z in zones if z not in fit]
    why += [f"zone {z.id}: more than {most} zones; {alone}" for z in fit[most:]]
    return fit[:most], [Note("WARN", text) for text in why]


def known_zones(
    state: State, frame: Frame, dialects: Dialects
) -> tuple[State, tuple[Zone, ...], list[Note]]:
    """The zones that peers are told, with those of the original's clients remembered, and about the others why not."""
    zones, notes = tellable(frame, state.zones.values())
    if Dialect.ORIGINAL in dialects.all:
        held, more = held_by_client(zones)
        notes = [*notes, *more]
        numbers = tuple(k for k, zone in enumerate(zones, 1) if zone in held)
        state = replace(state, client_zones=numbers)
    return state, zones, notes


def ended(state: State, vid: int, dialect: Dialect) -> tuple[State, list[Out]]:
    """A MissionCommand without waypoints: the mission of a vehicle that UxAS flies is over, and its instance is told.
    dialect: of that one."""
    craft, peer = state.craft(vid), state.link.peer(vid)
    if craft.plan is None or craft.away is not None:
        return state, [Refuse("mission without waypoints", f"vehicle {vid}")]
    state = state.put(vid, replace(craft, plan=None))
    if peer is None:
        return state, []
    over = replace(peer, way=(), flies=(), marks_m=(), from_m=0.0, reached=0, steered=None)
    state = replace(state, link=state.link.with_peer(over))
    return state, [
        *to_others(state.link, over, state.plane),
        Down(vid, placed(state, vid, MISSION_OVER, dialect)),
    ]


def over_meanwhile(state: State, vid: int, dialect: Dialect) -> list[Out]:
    """To an instance that comes again and may still have the plan of a mission that ended while it was away."""
    craft = state.craft(vid)
    if craft.plan is not None or craft.away is not None:
        return []
    return [Down(vid, placed(state, vid, MISSION_OVER, dialect))]


def free(state: State, vid: int) -> State:
    """The ICAROUS of a vehicle is heard: what made the vehicle hold is over."""
    craft = state.craft(vid)
    return state.put(vid, replace(craft, holds=False)) if craft.holds else state


def turn_radius_of(craft: Craft, air: AirState) -> float:
    """The turn radius [m] with which a vehicle's ICAROUS computes ways back."""
    profile = None if craft.configuration is None else craft.configuration.NominalFlightProfile
    bank = 0.0 if profile is None else math.radians(profile.MaxBankAngle)
    bank = min(bank, MOST_BANK_RAD) or DEFAULT_BANK_RAD
    return TURN_MARGIN * turn_radius_m(air.speed_m_s, bank)


def at_the_time_of(
    body: Any, crafts: Mapping[int, Craft]
) -> tuple[tuple[tuple[int, AirState], ...], frozenset[int]]:
    """Everybody flown on to the time of a state, by id; and who is not, because his own is too far from it."""
    aircraft, stale = [], set[int]()
    for other, craft in sorted(crafts.items()):
        if craft.air is None:
            continue
        first, last = sorted((int(craft.body.Time), int(body.Time)))
        if in_time(first, last, TRAFFIC_KEPT_MS):
            aircraft.append((other, moved(craft.air, (body.Time - craft.body.Time) / 1000)))
        else:
            stale.add(other)
    return tuple(aircraft), frozenset(stale)


def left_out(ids: Iterable[int]) -> list[Out]:
    """Warnings that these aircraft are not reported as traffic, because their states are too old."""
    text = f"no state within {TRAFFIC_KEPT_MS} ms; not told as traffic"
    return [Note("WARN", f"vehicle {vid}: {text}") for vid in sorted(ids)]


def moved(air: AirState, late_s: float) -> AirState:
    """The same aircraft some seconds later, straight on."""
    p, v = air.position, air.velocity
    place = Position(
        p.north_m + v.north_m_s * late_s,
        p.east_m + v.east_m_s * late_s,
        p.alt_m - v.down_m_s * late_s,
    )
    return air._replace(position=place)


def placed(
    state: State, vid: int, lines: tuple[Message, ...], dialect: Dialect
) -> tuple[Message, ...]:
    """As a peer of another dialect than ours reads them: RESET_SFT with where the vehicle is, and for the original's
    client WAYPT with a running count, and the zones that it holds alone."""
    if dialect.ours:
        return lines
    # it has no words to forget the one alone: it forgets all, and is told the other anew
    if lines == (ForgetFences(),):
        peer = state.link.peer(vid)
        assert peer is not None
        lines = (HardReset(), *onward(peer.way, peer.reached))
    elif lines == MISSION_OVER:
        zones = enumerate(state.link.zones, 1)
        fences = (line for number, zone in zones for line in fence(zone, number, state.plane))
        lines = (HardReset(), *fences)
    if dialect is Dialect.ORIGINAL:
        lines = tuple(_numbered(x, state.client_zones) for x in lines if _held(x, state))
    return tuple(_placed(state, vid, line, dialect) for line in lines)


def _held(line: Message, state: State) -> bool:
    return not isinstance(line, FenceVertex | FenceDone) or line.zone in state.client_zones


def _numbered(line: Message, told: tuple[int, ...]) -> Message:
    """The client keeps its zones by their numbers, which have to be 1 to n."""
    if isinstance(line, FenceVertex | FenceDone) and line.zone is not None:
        return replace(line, zone=told.index(line.zone) + 1)
    return line


def _placed(state: State, vid: int, line: Message, dialect: Dialect) -> Message:
    if dialect is Dialect.ORIGINAL and isinstance(line, Waypoint):
        return replace(line, total=line.index + 1)
    if not isinstance(line, SoftReset) or line.lat_deg is not None:
        return line
    air = state.craft(vid).air
    if air is None or state.frame is None:
        return SoftReset(0.0, 0.0, 0.0)  # as the original's service has it before a mission
    lat, long = plane(state.frame).to_geodetic(air.position.north_m, air.position.east_m)
    return SoftReset(lat, long, air.position.alt_m)


def goes_on(state: State, vid: int, line: Message) -> State:
    """The same with the waypoint with which the ICAROUS of a vehicle that it has goes on: GOTOWP says it, and steering
    that comes later says that it does not."""
    craft = state.craft(vid)
    if craft.away is None:
        return state
    waypoint = line.index if isinstance(line, GoToWaypoint) else None
    return state.put(vid, replace(craft, away=craft.away._replace(waypoint=waypoint)))


def led_back(state: State, vid: int, places: Iterable[tuple[float, float, float]]) -> State:
    """The same with the way (latitude, longitude [deg], altitude [m]) onto which a vehicle that ICAROUS has is handed
    back."""
    craft = state.craft(vid)
    if craft.away is None or state.frame is None:
        return state
    to_local = plane(state.frame).to_local
    proposed = tuple(Position(*to_local(lat, long), alt_m) for lat, long, alt_m in places)
    return state.put(vid, replace(craft, away=craft.away._replace(proposed=proposed)))
