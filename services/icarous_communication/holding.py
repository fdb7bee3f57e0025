"""UxAS's own commands to a vehicle that has an instance: a hold where it is, and their record at its gate."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.authority.gate import ICAROUS, UXAS, gate_accepts
from cratous.core.avoidance.manoeuvre import velocity_of
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.messages import Say
from cratous.services.icarous_communication import modes
from cratous.services.icarous_communication.listeners import Dialects
from cratous.services.icarous_communication.plans import Away, being_done
from cratous.services.icarous_communication.state import (
    COMMANDS_FROM,
    Note,
    Out,
    State,
    plane,
    turn_radius_of,
)
from cratous.services.icarous_communication.steering import at_gate, circle_about, command_of, told
from cratous.services.mission.zones import exact_leg_ok
from cratous.services.pipeline.status import status
from cratous.spec.mission import Position, Zone

Step = tuple[State, list[Out]]
CORNERS = 32
"""Corners of the polygon around a circle that is compared with zones."""
RIGHT, LEFT = 1, -1


class Sender(NamedTuple):
    """name: of the service; dialects: of its peers."""

    name: str
    dialects: Dialects


def icarous_has(state: State, vid: int) -> bool:
    """Whether a vehicle's gate obeys its ICAROUS."""
    peer = state.link.peer(vid)
    return peer is not None and gate_accepts(peer.gate, ICAROUS, peer.gate.epoch)


def commanded(sender: Sender, state: State, vid: int, action: Any) -> tuple[State, Say]:
    """A VehicleActionCommand of this service."""
    state = replace(state, commands=state.commands + 1)
    return state, Say(command_of(vid, COMMANDS_FROM + state.commands, action), sender.name)


def by_uxas(sender: Sender, state: State, vid: int, command: Any) -> list[Out]:
    """UxAS's command at the gate of a vehicle, if the vehicle has one here."""
    peer = state.link.peer(vid)
    if peer is None or modes.unknown(peer, sender.dialects.ours(vid) and vid in state.fresh):
        return []
    return [at_gate(sender.name, vid, peer.gate, UXAS, command)]


def hold(sender: Sender, state: State, vid: int, out: list[Out], why: str) -> Step:
    """Let a vehicle hold where it is: a level circle that begins on its course."""
    craft = state.craft(vid)
    said = Say(status(0, "Error", [("reason", f"vehicle {vid} holds: {why}")]), sender.name)
    if craft.air is None or state.frame is None:
        return state, [*out, said]
    air, radius_m = craft.air, turn_radius_of(craft, craft.air)
    # a turn is flown on: rolling to the other side would carry it out of the circle
    first = LEFT if craft.body is not None and craft.body.Roll < 0 else RIGHT
    sides = [(side, _centre(air, radius_m, side)) for side in (first, -first)]
    kept = [one for one in sides if _keeps(one[1], radius_m, state.link.zones)]
    side, centre = (kept or sides)[0]
    lat_deg, long_deg = plane(state.frame).to_geodetic(centre.north_m, centre.east_m)
    turn = "Clockwise" if side == RIGHT else "CounterClockwise"
    action = circle_about(lat_deg, long_deg, air, radius_m, turn)
    state, sent = commanded(sender, state, vid, action)
    out = [*out, *by_uxas(sender, state, vid, sent.body), sent, said]
    return state.put(vid, replace(state.craft(vid), holds=True)), out


def about_tasks(sender: Sender, kind: str, tasks: Iterable[int]) -> list[Out]:
    """A TaskPause or TaskResume for each task."""
    return [Say(lmcp.new(kind, TaskID=task), sender.name) for task in tasks]


def off_plan(sender: Sender, state: State, vid: int) -> Step:
    """UxAS leaves the plan of a vehicle that it has, and its tasks pause."""
    craft = state.craft(vid)
    if craft.air is None or craft.away is not None:
        return state, []
    tasks = being_done(craft.plan, craft.listed)
    away = Away(craft.air.position, tasks, paused=bool(tasks))
    return state.put(vid, replace(craft, away=away)), about_tasks(sender, "TaskPause", tasks)


def missions_at_gate(sender: Sender, state: State, vid: int, sent: Iterable[Out]) -> list[Out]:
    """The MissionCommands among what is sent, as UxAS's commands at the gate."""
    bodies = [one.body for one in sent if isinstance(one, Say)]
    commands = [body for body in bodies if type(body).__name__ == "MissionCommand"]
    return [one for command in commands for one in by_uxas(sender, state, vid, command)]


def taken_over(sender: Sender, state: State, vid: int, now_ms: int) -> Step:
    """ICAROUS has taken a vehicle: it flies its plan no longer."""
    craft, peer = state.craft(vid), state.link.peer(vid)
    assert peer is not None
    tasks = being_done(craft.plan, craft.listed)  # tasks not yet reached need no pause
    left = Position(0.0, 0.0, 0.0) if craft.air is None else craft.air.position
    # a reconnected instance has had the vehicle all the time
    state = state.put(vid, replace(craft, away=craft.away or Away(left, tasks)))
    text = f"vehicle {vid}: ICAROUS has it, in epoch {peer.gate.epoch}"
    return state, [Note("WARN", text), *told(sender.name, vid, now_ms, peer.gate)]


def held(sender: Sender, state: State, vid: int, out: list[Out]) -> Step:
    """Let a vehicle hold while ICAROUS has it but is not heard."""
    peer, craft = state.link.peer(vid), state.craft(vid)
    if peer is None or peer.end.alive or craft.holds or not icarous_has(state, vid):
        return state, out
    return hold(sender, state, vid, out, "its ICAROUS, which has it, is not heard")


def _centre(air: AirState, radius_m: float, side: int) -> Position:
    """Centre of a circle on one side of a course, tangent to it."""
    towards = velocity_of(air.heading_rad + side * math.pi / 2, radius_m, 0.0)
    here = air.position
    return Position(here.north_m + towards.north_m_s, here.east_m + towards.east_m_s, here.alt_m)


def _keeps(centre: Position, radius_m: float, zones: tuple[Zone, ...]) -> bool:
    """Whether the polygon around a circle keeps all zones."""
    around_m = radius_m / math.cos(math.pi / CORNERS)
    spokes = (velocity_of(2 * math.pi * k / CORNERS, around_m, 0.0) for k in range(CORNERS))
    ring = [
        centre._replace(north_m=centre.north_m + v.north_m_s, east_m=centre.east_m + v.east_m_s)
        for v in spokes
    ]
    legs = list(zip(ring, ring[1:] + ring[:1], strict=True))
    return all(exact_leg_ok(a, b, zone) for zone in zones for a, b in legs)
