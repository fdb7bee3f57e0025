"""One ICAROUS instance: a pure step MONITOR -> AVOID -> HANDBACK -> MONITOR, once a heartbeat.

MONITOR: UxAS flies; the way ahead is checked against traffic and zones. AVOID: ICAROUS has taken
over and flies the manoeuvre that deviates least from the course. HANDBACK: the way back has been
free for a while, control is offered; ICAROUS steers on until UxAS takes it, and withdraws the
offer when a conflict shows up. Own state and traffic come from the vehicle itself; the bridge
brings zones, waypoints and commands, and takes away SETMOD, SETVEL and HBEAT. Without the bridge
there is no offer: the instance flies on along the waypoints it knows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import NamedTuple

from cratous.bridge.text_protocol import Heartbeat, Message, SetMode, SetVelocity
from cratous.core.authority.gate import (
    ICAROUS,
    Gate,
    gate_accepts,
    gate_offer,
    gate_takeover,
    handback,
)
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.avoidance.manoeuvre import Ability, Motion, along, velocity_of
from cratous.core.avoidance.prediction import Intruder, Piece, buffered
from cratous.core.avoidance.resolution import Choice, Scene, first_conflict_s, first_zone_s, resolve
from cratous.services.icarous.geofence_monitor import zone_ahead_s
from cratous.services.icarous.inbox import Told, hear
from cratous.services.icarous.return_to_path import (
    RELAPSE_MS,
    bearing_rad,
    goal_index,
    persistence_ms,
    way_back,
)
from cratous.services.icarous.traffic_monitor import (
    Threat,
    Tracks,
    courses,
    hard_limit_s,
    last_time_s,
    most_urgent,
    threats,
    turning,
)
from cratous.services.mission.frames import Projection
from cratous.spec.authority.gate import OFFER, WITHDRAW
from cratous.spec.mission import Daa, Position, Velocity

LINK_LOST_MS = 2000
"""The bridge counts as lost when nothing was heard for this long [ms]: four heartbeats."""
ON_PATH_M = 30.0
"""Nearer than this to its path a vehicle is taken to fly along it; else straight on [m]."""
TURN_MARGIN = 1.1
"""The way back is made of turns this much wider than the tightest."""


class Mode(StrEnum):
    MONITOR = "monitor"
    AVOID = "avoid"
    HANDBACK = "handback"


class Config(NamedTuple):
    """What does not change: whose instance, what it keeps clear of, and the heartbeat [ms]."""

    vehicle_id: int
    daa: Daa
    projection: Projection
    heartbeat_ms: int


class Inputs(NamedTuple):
    """What the vehicle gives its instance at a heartbeat, and what came over the bridge."""

    now_ms: int
    motion: Motion
    ability: Ability
    intruders: tuple[Intruder, ...]
    gate: Gate
    messages: tuple[Message, ...]


@dataclass(frozen=True)
class State:
    """Everything the instance remembers."""

    mode: Mode = Mode.MONITOR
    told: Told = field(default_factory=Told)
    threats: tuple[Threat, ...] = ()
    courses: Tracks = ()
    held: Choice | None = None
    clear_since_ms: int | None = None
    handback_ms: int | None = None
    relapses: int = 0
    goal: int = 0
    beats: int = 0


@dataclass(frozen=True)
class Outputs:
    """What it wants: authority ("takeover", "offer" or ""), a velocity, and lines to send."""

    authority: str = ""
    reason: str = ""
    intruder_id: int = 0
    first_violation_s: float = -1.0
    velocity: Velocity | None = None
    messages: tuple[Message, ...] = ()
    resolution: str = ""


def step(config: Config, state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """One heartbeat."""
    told = hear(state.told, inputs.messages, config.projection, inputs.now_ms)
    state = replace(state, told=told, beats=state.beats + 1)
    beat = Heartbeat(sequence=state.beats, time_s=inputs.now_ms / 1000)
    commands = gate_accepts(inputs.gate, ICAROUS, inputs.gate.epoch)
    if state.mode is not Mode.MONITOR and not commands:
        state = replace(state, mode=Mode.MONITOR, handback_ms=inputs.now_ms, held=None, threats=())
    now = courses(inputs.intruders)
    in_turn = turning(now, state.courses, config.heartbeat_ms / 1000)
    state = replace(state, courses=now)
    if state.mode is Mode.MONITOR:
        state, outputs = _monitor(config, state, inputs, in_turn)
    else:
        state, outputs = _command(config, state, inputs)
    return state, replace(outputs, messages=(*outputs.messages, beat))


def predicted(state: State, inputs: Inputs, lookahead_s: float) -> tuple[Piece, ...]:
    """The own way ahead: along the waypoints while on the path, else straight on."""
    told, motion = state.told, inputs.motion
    index = told.next_index
    if 0 < index < len(told.waypoints):
        a, b = told.waypoints[index - 1], told.waypoints[index]
        if _off_m(motion.position, a, b) <= ON_PATH_M:
            ahead = told.waypoints[index:]
            half_s = motion.speed_m_s * 0.5
            near = math.hypot(
                ahead[0].north_m - motion.position.north_m,
                ahead[0].east_m - motion.position.east_m,
            )
            # a waypoint that is as good as reached says nothing about the direction of flight
            if near < half_s and len(ahead) > 1:
                ahead = ahead[1:]
            return along(motion, ahead, lookahead_s)
    v = velocity_of(motion.heading_rad, motion.speed_m_s, motion.climb_m_s)
    return (Piece(0.0, lookahead_s, motion.position, v),)


def _off_m(p: Position, a: Position, b: Position) -> float:
    north, east = b.north_m - a.north_m, b.east_m - a.east_m
    length = math.hypot(north, east)
    dn, de = p.north_m - a.north_m, p.east_m - a.east_m
    if length < 1e-9:
        return math.hypot(dn, de)
    return abs(north * de - east * dn) / length


def _scene(config: Config, state: State, inputs: Inputs) -> Scene:
    daa = config.daa
    volume = buffered(daa.well_clear, daa.buffer)
    return Scene(inputs.intruders, state.told.zones, volume, daa.lookahead_s)


def _monitor(
    config: Config, state: State, inputs: Inputs, in_turn: frozenset[int]
) -> tuple[State, Outputs]:
    scene = _scene(config, state, inputs)
    pieces = predicted(state, inputs, scene.lookahead_s)
    last_s = last_time_s(inputs.ability, scene.volume, config.heartbeat_ms)
    found = threats(
        config.vehicle_id,
        pieces,
        inputs.intruders,
        scene.volume,
        state.threats,
        inputs.now_ms,
        last_s,
        hard_limit_s(inputs.ability, config.heartbeat_ms),
        in_turn,
    )
    state = replace(state, threats=found)
    urgent = most_urgent(found)
    if urgent is not None:
        return _take_over(
            config, state, inputs, "traffic", urgent.intruder_id, urgent.first_violation_s
        )
    if len(pieces) == 1:
        zone_s = zone_ahead_s(inputs.motion, inputs.ability, pieces, state.told.zones)
        if zone_s is not None:
            return _take_over(config, state, inputs, "zone", 0, zone_s)
    return state, Outputs()


def _take_over(
    config: Config, state: State, inputs: Inputs, why: str, intruder_id: int, first_s: float
) -> tuple[State, Outputs]:
    before_ms = state.handback_ms
    soon = before_ms is not None and not lasted(before_ms, inputs.now_ms, RELAPSE_MS)
    told = state.told
    state = replace(
        state,
        mode=Mode.AVOID,
        relapses=state.relapses + 1 if soon else 0,
        clear_since_ms=None,
        goal=told.next_index,
    )
    state, choice, velocity = _manoeuvre(config, state, inputs)
    epoch = gate_takeover(inputs.gate).epoch
    reason = f"{why}: loss predicted in {first_s:.1f} s"
    return state, Outputs(
        authority="takeover",
        reason=reason,
        intruder_id=intruder_id,
        first_violation_s=first_s,
        velocity=velocity,
        messages=(SetMode("ACTIVE", epoch), _set_velocity(velocity)),
        resolution=describe(choice),
    )


def _command(config: Config, state: State, inputs: Inputs) -> tuple[State, Outputs]:
    """AVOID and HANDBACK: fly the manoeuvre, and see whether the way back is free."""
    free = _way_back_is_free(config, state, inputs)
    since = state.clear_since_ms
    since = (inputs.now_ms if since is None else since) if free else None
    state = replace(state, clear_since_ms=since)
    before = state.held
    state, choice, velocity = _manoeuvre(config, state, inputs)
    changed = before is None or describe(before) != describe(choice)
    told_again = describe(choice) if changed else ""
    outputs = Outputs(velocity=velocity, messages=(_set_velocity(velocity),), resolution=told_again)
    linked = in_time(state.told.heard_ms, inputs.now_ms, LINK_LOST_MS)
    long = since is not None and lasted(since, inputs.now_ms, persistence_ms(state.relapses))
    due = handback(state.mode is Mode.HANDBACK, free, long, linked)
    if due == WITHDRAW:
        epoch = gate_takeover(inputs.gate).epoch
        return replace(state, mode=Mode.AVOID), replace(
            outputs,
            authority="takeover",
            reason="offer withdrawn: the way back is no longer free",
            resolution=f"offer withdrawn; {describe(choice)}",
            messages=(SetMode("ACTIVE", epoch), *outputs.messages),
        )
    if due == OFFER:
        epoch = gate_offer(inputs.gate).epoch
        return replace(state, mode=Mode.HANDBACK), replace(
            outputs,
            authority="offer",
            reason="the way back is free",
            messages=(SetMode("PASSIVE", epoch), *outputs.messages),
        )
    return state, outputs


def _goal(state: State, inputs: Inputs) -> tuple[State, Position | None]:
    """The waypoint to make for; none if no waypoints are known."""
    waypoints = state.told.waypoints
    if not waypoints:
        return state, None
    radius_m = inputs.motion.speed_m_s / inputs.ability.turn_rate_rad_s
    index = goal_index(inputs.motion, radius_m, waypoints, min(state.goal, len(waypoints) - 1))
    return replace(state, goal=index), waypoints[index]


def _manoeuvre(config: Config, state: State, inputs: Inputs) -> tuple[State, Choice, Velocity]:
    state, goal = _goal(state, inputs)
    motion = inputs.motion
    course = bearing_rad(motion.position, goal) if goal is not None else motion.heading_rad
    speed = state.told.speed_m_s or motion.speed_m_s
    choice = resolve(
        motion, inputs.ability, _scene(config, state, inputs), course, speed, state.held
    )
    velocity = velocity_of(choice.heading_rad, choice.speed_m_s, choice.climb_m_s)
    return replace(state, held=choice), choice, velocity


def _way_back_is_free(config: Config, state: State, inputs: Inputs) -> bool:
    """The way onto the path and along it is free of predicted conflict over the look-ahead."""
    told, scene = state.told, _scene(config, state, inputs)
    if not told.waypoints:
        pieces = predicted(state, inputs, scene.lookahead_s)
    else:
        points = told.waypoints[state.goal :]
        if told.resume is not None:
            points = (told.resume, *told.waypoints[min(told.next_index, len(told.waypoints)) :])
        radius_m = TURN_MARGIN * inputs.motion.speed_m_s / inputs.ability.turn_rate_rad_s
        pieces = way_back(inputs.motion, radius_m, points, scene.lookahead_s)
    if first_conflict_s(pieces, scene) is not None:
        return False
    return first_zone_s(pieces, scene.zones, 5.0) is None if len(pieces) > 1 else True


def _set_velocity(v: Velocity) -> SetVelocity:
    return SetVelocity(north_mps=v.north_m_s, east_mps=v.east_m_s, down_mps=v.down_m_s)


def describe(choice: Choice) -> str:
    """A manoeuvre in words, for the record; it says when none is free of conflict."""
    heading = round(math.degrees(choice.heading_rad)) % 360
    text = f"heading {heading:03d}"
    if choice.kind == "altitude":
        text += f", climb {choice.climb_m_s:+.1f} m/s"
    if choice.kind == "speed":
        text += f", speed {choice.speed_m_s:.1f} m/s"
    if not choice.clear:
        text += f"; no manoeuvre is free of conflict, this one is until {choice.first_violation_s:.1f} s"
    return text
