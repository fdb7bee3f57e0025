"""State of the UxAS end of the bridge about vehicles and zones, and helpers to derive its messages."""

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
from cratous.core.authority.link_loss import LINKED, Loss
from cratous.core.authority.timeliness import in_time
from cratous.services.flight import link_end
from cratous.services.flight.dynamics import AirState, turn_radius_m
from cratous.services.flight.link_lines import fence, onward
from cratous.services.flight.link_peers import to_others
from cratous.services.flight.messages import Down, Say
from cratous.services.icarous.route_end import TURN_MARGIN
from cratous.services.icarous_communication.listeners import Dialects
from cratous.services.icarous_communication.plans import Away, Plan, position_of
from cratous.services.mission.frames import Projection
from cratous.services.uxas.daidalus.zones import surroundings
from cratous.spec.mission import Frame, Position, Zone

TRAFFIC_KEPT_MS = 5000
"""Aircraft whose states differ in time by more than this are not reported to each other [ms]."""
SPARE_WAYPOINTS = 10
"""The original's client is sent the next part of a plan when at most this many waypoints are ahead."""
SETTLES_MS = 2000
"""After this long, a vehicle is assumed to fly a new plan even if it has not reported its first waypoint
[ms].
"""
COMMANDS_FROM = 2**40
"""Ids of this service's commands start here, apart from those of other senders."""
MOST_BANK_RAD = math.radians(80.0)
DEFAULT_BANK_RAD = math.radians(30.0)
"""Bank limit used, and the one assumed without a configured value [rad]."""


NO_LOSS = Loss(LINKED, 0)
MISSION_OVER = StopMission(), ForgetWaypoints()
"""Lines sent to an instance when its vehicle's mission is over."""


class Refuse(NamedTuple):
    """To the log: input was ignored. why: reason, by which it is counted; detail: of this case."""

    why: str
    detail: str


class Note(NamedTuple):
    """To the log. severity: logging level."""

    severity: str
    text: str


Out = Say | Down | Refuse | Note


@dataclass(frozen=True)
class Craft:
    """What is known of one vehicle.

    configuration: AirVehicleConfiguration; body, air: newest AirVehicleState and its motion in the plane;
    plan: in force; away: set while it does not fly it; holds: commanded to hold because its ICAROUS is not
    heard; handed: just handed back, so late steering of ICAROUS is expected; waiting: mission received
    meanwhile; loss: its lost-link procedure; first: where it was first seen; returns: MissionCommand on which
    it returns without the link.
    """

    configuration: Any = None
    body: Any = None
    air: AirState | None = None
    plan: Plan | None = None
    away: Away | None = None
    holds: bool = False
    handed: bool = False
    waiting: Any = None
    loss: Loss = NO_LOSS
    first: Position | None = None
    returns: Any = None

    @property
    def listed(self) -> tuple[int, ...]:
        """The tasks in its newest state."""
        return () if self.body is None else tuple(self.body.AssociatedTasks)


@dataclass(frozen=True)
class State:
    """link: state of the end; frame: the plane, None before the first position; zones, crafts: by id;
    commands: number issued; fresh: vehicles whose instance has not yet stated its epoch; stale: vehicles
    not reported as traffic; client_zones: numbers, from 1, of the zones sent to the original's clients.
    """

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
        """The projection of the frame; an arbitrary one without a frame."""
        return plane(self.frame or Frame(0.0, 0.0))

    def craft(self, vehicle_id: int) -> Craft:
        """What is known of a vehicle."""
        return self.crafts.get(vehicle_id, Craft())

    def put(self, vehicle_id: int, craft: Craft) -> State:
        """The state with this record of a vehicle."""
        return replace(self, crafts={**self.crafts, vehicle_id: craft})


@lru_cache(maxsize=16)
def plane(frame: Frame) -> Projection:
    """The cached projection of a frame."""
    return Projection(frame)


def air_state(body: Any, projection: Projection) -> AirState:
    """Motion from an AirVehicleState: from body axes (u forward, v right, w down), or from ground speed and
    course if u and v are 0.
    """
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
    """The zones that are sent to peers, and a note for each that is not."""
    around = surroundings(frame, bodies, "MSL")
    return around.zones, [Note("WARN", text) for text in around.missing]


def held_by_client(zones: tuple[Zone, ...]) -> tuple[tuple[Zone, ...], list[Note]]:
    """The zones that the original's client is sent, and why not the others: it publishes a fence for each
    GEOFN_SEND, with whatever it has received, and counts zones itself.
    """
    most, corners = ORIGINAL_LIMITS.zones, ORIGINAL_LIMITS.vertices
    fit = tuple(zone for zone in zones if len(zone.vertices) in range(corners + 1))
    alone = "the original's client is not told of it"
    why = [f"zone {z.id}: more than {corners} vertices; {alone}" for z in zones if z not in fit]
    why += [f"zone {z.id}: more than {most} zones; {alone}" for z in fit[most:]]
    return fit[:most], [Note("WARN", text) for text in why]


def known_zones(
    state: State, frame: Frame, dialects: Dialects
) -> tuple[State, tuple[Zone, ...], list[Note]]:
    """The zones to send to peers, with the original's clients' subset stored, and notes on the others."""
    zones, notes = tellable(frame, state.zones.values())
    if Dialect.ORIGINAL in dialects.all:
        held, more = held_by_client(zones)
        notes = [*notes, *more]
        numbers = tuple(k for k, zone in enumerate(zones, 1) if zone in held)
        state = replace(state, client_zones=numbers)
    return state, zones, notes


def ended(state: State, vid: int, dialect: Dialect) -> tuple[State, list[Out]]:
    """A MissionCommand without waypoints: the mission of a vehicle under UxAS is over, and its instance is
    told.

    dialect: of that instance.
    """
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
    """Lines for a reconnected instance that may still have the plan of a mission that ended meanwhile."""
    craft = state.craft(vid)
    if craft.plan is not None or craft.away is not None:
        return []
    return [Down(vid, placed(state, vid, MISSION_OVER, dialect))]


def free(state: State, vid: int) -> State:
    """A vehicle's ICAROUS is heard again: it no longer has to hold."""
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
    """All aircraft extrapolated to the time of a state, by id; and those whose state is too far from it in
    time.
    """
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
    """The aircraft after late_s [s] of straight flight."""
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
    """Lines adapted to the dialect of a peer: RESET_SFT with the vehicle's position, and for the original's
    client WAYPT with a running count and only the zones that it can hold.
    """
    if dialect.ours:
        return lines
    # it can only forget everything: the part that stays is sent again
    if lines == (ForgetFences(),):
        peer = state.link.peer(vid)
        assert peer is not None
        lines = (HardReset(), *onward(peer.way, peer.reached))
    elif lines[:1] == (ForgetFences(),):  # all else follows
        lines = (HardReset(), *lines[1:])
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
    """The client indexes its zones by number, from 1 to n."""
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
        return SoftReset(0.0, 0.0, 0.0)  # as the original's service does before a mission
    lat, long = plane(state.frame).to_geodetic(air.position.north_m, air.position.east_m)
    return SoftReset(lat, long, air.position.alt_m)


def goes_on(state: State, vid: int, line: Message) -> State:
    """Record the waypoint at which the ICAROUS that has a vehicle continues: set by GOTOWP, cleared by later
    steering.
    """
    craft = state.craft(vid)
    if craft.away is None:
        return state
    waypoint = line.index if isinstance(line, GoToWaypoint) else None
    return state.put(vid, replace(craft, away=craft.away._replace(waypoint=waypoint)))


def led_back(state: State, vid: int, places: Iterable[tuple[float, float, float]]) -> State:
    """Record the route (latitude, longitude [deg], altitude [m]) on which ICAROUS hands a vehicle back."""
    craft = state.craft(vid)
    if craft.away is None or state.frame is None:
        return state
    to_local = plane(state.frame).to_local
    proposed = tuple(Position(*to_local(lat, long), alt_m) for lat, long, alt_m in places)
    return state.put(vid, replace(craft, away=craft.away._replace(proposed=proposed)))
