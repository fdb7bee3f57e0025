"""The executive's outgoing commands, routes, progress reports and camera directions, derived from its state."""

from __future__ import annotations

from cratous.core.authority.gate import UXAS
from cratous.core.authority.link_end import track_is_told
from cratous.services.flight.chain import Phase
from cratous.services.flight.commands import gated, path_command
from cratous.services.flight.deadlines import opens
from cratous.services.flight.executive_state import Config, Out, State
from cratous.services.flight.merge_routes import comes_before
from cratous.services.flight.messages import Flown, Look, Route, Say
from cratous.services.flight.remaining_path import points_ahead, points_left
from cratous.services.flight.sensing import looks
from cratous.services.flight.task_transitions import NAME
from cratous.services.mission.merging import merges
from cratous.spec.mission.link_loss import WithoutLink
from cratous.spec.records import replace

AHEAD_S = 30
"""Routes are sent this much farther than the look-ahead [s]."""

WHOLE_M = 1e6
"""Length told of a route that is to be flown to its end without the link, or over a merge fix [m]."""


def command(
    config: Config, state: State, vehicle_id: int, epoch: int, out: Out, source: str = NAME
) -> State:
    """Command the rest of the present track, through the vehicle's gate."""
    chain, number = state.chain(vehicle_id), state.commands + 1
    tasks = (chain.item.task_id,) if chain.item and chain.phase is Phase.TASK else ()
    points, speed = points_left(chain), chain.speed_m_s
    body = path_command(config.projection, vehicle_id, number, points, speed, tasks)
    out.append(Say(gated(vehicle_id, epoch, UXAS, body), source))
    return replace(state, commands=number)


def command_all(config: Config, state: State, out: Out) -> State:
    """Command the present tracks of all vehicles that are not suspended."""
    for chain in state.chains:
        vid = chain.vehicle.id
        if not chain.suspended:
            state = command(config, state, vid, state.epoch(vid), out)
    return state


def route(state: State, vehicle_id: int, out: Out) -> State:
    """Send ICAROUS the route ahead: the present track and what follows, up to its look-ahead."""
    chain = state.chain(vehicle_id)
    chain = replace(chain, told_version=chain.route_version)
    opens_ms = opens(state, chain.item, chain.since_ms) if chain.item is not None else 0
    ahead_m = chain.vehicle.max_speed_m_s * (state.mission.daa.lookahead_s + AHEAD_S)
    loss = state.mission.link_loss
    whole = loss is not None and loss.choice is WithoutLink.FINISH
    merging = merges(state.mission, vehicle_id)
    if whole or merging is not None:
        ahead_m = WHOLE_M
    if merging is not None and comes_before(merging, chain):
        ahead_m = 0.0  # for its slot it would be flown over its task
    speed = chain.item.speed_m_s if chain.item and not chain.holds else chain.speed_m_s
    out.append(Route(vehicle_id, points_ahead(chain, opens_ms, ahead_m), speed, chain.s_m))
    return state.put(chain)


def report(state: State, vehicle_id: int, out: Out) -> State:
    """Report a vehicle's progress along its route, and first the route itself if it has changed."""
    chain = state.chain(vehicle_id)
    if track_is_told(chain.suspended, chain.route_version != chain.told_version):
        state = route(state, vehicle_id, out)
    if not chain.suspended:
        out.append(Flown(vehicle_id, chain.s_m))
    return state


def look(config: Config, state: State, vehicle_id: int, now_ms: int) -> Look:
    """Where a vehicle's cameras point."""
    chain, air = state.chain(vehicle_id), state.air(vehicle_id)
    vehicle = config.mission.vehicle(vehicle_id)
    sees = looks(vehicle, chain, air, config.mission, config.projection)
    return Look(vehicle_id, now_ms, tuple(sees.payloads), tuple(sees.tasks))
