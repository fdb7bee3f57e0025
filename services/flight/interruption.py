"""Transfers of authority between UxAS and ICAROUS, and loss of the link: their effect on a vehicle's chain."""

from __future__ import annotations

from cratous.core.authority.link_end import suspended_after
from cratous.core.executive.steps import way_act
from cratous.services.flight import failing
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.executive_outputs import command, route
from cratous.services.flight.executive_state import Config, Out, State
from cratous.services.flight.hold_paths import held_again
from cratous.services.flight.legs import take_off_of
from cratous.services.flight.messages import (
    Because,
    HeardAgain,
    Left,
    NotHeard,
    Proposed,
    RouteAsked,
    Stands,
    Suspend,
    TakeBack,
)
from cratous.services.flight.remaining_path import leaving_m
from cratous.services.flight.task_transitions import NAME as EXECUTIVE
from cratous.services.flight.task_transitions import NO_WAY, circling, fail, progress
from cratous.spec.authority.cycle import TAKE_OVER
from cratous.spec.executive import FAIL_TASK
from cratous.spec.mission import Change, Position
from cratous.spec.mission.changes import VEHICLE_LANDED
from cratous.spec.mission.plan import Pose
from cratous.spec.records import replace

NAME = "uxas/ics"
"""Sender of messages that the bridge gives rise to."""


def suspend(state: State, message: Suspend, out: Out) -> State:
    """ICAROUS has taken over: the path is interrupted, and ICAROUS is told where to resume it."""
    chain = state.chain(message.vehicle_id)
    was, chain = (
        chain,
        replace(chain, suspended=suspended_after(chain.suspended, message.act)),
    )
    if chain.suspended and not was.suspended:
        chain = replace(chain, leg=chain.leg.taken(message.now_ms))
    left = _resume_point(chain)
    if left is not None:
        out.append(Left(message.vehicle_id, left))
        if chain.phase is Phase.TASK and not was.suspended and not was.away:
            note = f"left the path at {chain.path_flown_m():.0f} m"
            said = progress(chain, message.now_ms, "Suspended", note, chain.served())
            out.append(said._replace(source=NAME))
    return state.put(chain)


def because(state: State, message: Because) -> State:
    """Record the reason for a takeover in the leg."""
    chain = state.find(message.vehicle_id)
    if chain is None or message.act != TAKE_OVER:
        return state
    text = message.reason + (f" with {message.intruder_id}" if message.intruder_id else "")
    return state.put(replace(chain, leg=chain.leg._replace(because=text)))


def _resume_point(chain: Chain) -> Position | None:
    """Where the path is resumed: slightly before where a task was interrupted, so that no coverage is lost;
    before a task, its start at the latest; None after the last item.
    """
    if chain.phase is Phase.TASK:
        return chain.track.at(leaving_m(chain))
    return chain.track.points[-1] if chain.item is not None else None


def propose(config: Config, state: State, message: RouteAsked, out: Out) -> None:
    """ICAROUS requests a route back: propose one from the router that ends in the direction of the vehicle's
    track; empty where UxAS has the vehicle or no route exists.
    """
    vid, start, end, number = message
    chain = state.find(vid)
    way: tuple[Position, ...] = ()
    if chain is not None and chain.suspended:
        near = chain.track.nearest(end, 0.0, chain.track.length_m)
        target = Pose(*end, chain.track.heading_rad(near.s_m))
        way = config.ways(state.zones).way_to(chain, start, target)
    out.append(Proposed(vid, number, way, start.speed_m_s))


def take_back(config: Config, state: State, message: TakeBack, out: Out) -> State:
    """ICAROUS hands back: fly to the resume point, then along the rest of the path.

    Where no way there keeps the zones, the task fails and the next one follows; after the last, the vehicle
    circles.
    """
    vid, now_ms = message.vehicle_id, message.now_ms
    chain = state.chain(vid)
    if chain.suspended:
        chain = replace(chain, leg=chain.leg.given_back(now_ms, take_off_of(state, chain.vehicle)))
    state = replace(state, epochs=tuple({**dict(state.epochs), vid: message.epoch}.items()))
    chain = replace(chain, suspended=suspended_after(chain.suspended, message.act))
    return flown_back(config, state, chain, now_ms, NAME, out)


def unlinked(state: State, message: NotHeard) -> State:
    """A vehicle is not heard: it acts autonomously, and its chain is suspended. This time does not count as
    time under ICAROUS.
    """
    chain = state.find(message.vehicle_id)
    if chain is None:
        return state
    leg = chain.leg.given_back(message.now_ms) if chain.suspended else chain.leg
    return state.put(replace(chain, suspended=True, unlinked=True, leg=leg))


def linked(config: Config, state: State, message: HeardAgain, out: Out) -> State:
    """A vehicle is heard again. If UxAS has it, it flies on from where it is; otherwise ICAROUS will hand it
    back.
    """
    vid, now_ms, by_uxas = message
    chain = state.find(vid)
    if chain is None or not chain.unlinked or vid in dict(state.declared):
        return state
    chain = replace(chain, unlinked=False, leg=chain.leg._replace(taken_ms=now_ms))
    if not by_uxas:
        return state.put(chain)
    return flown_back(config, state, replace(chain, suspended=False), now_ms, EXECUTIVE, out)


def landed(state: State, message: Stands) -> State:
    """A vehicle is at rest on the ground and flies no more: a change that lets its remaining tasks be
    reassigned.
    """
    vid, now_ms = message.vehicle_id, state.now_ms
    where = f"at {message.site}" if message.site else "beside every landing site"
    told = (
        *state.landed,
        (vid, f"it has landed {where}, and stands there since {now_ms / 1000:.2f} s"),
    )
    if vid in dict(state.declared):
        return failing.settled(replace(state, landed=told), vid, now_ms)
    news = Change(now_ms, VEHICLE_LANDED, vehicle=vid)
    return replace(state, landed=told, to_come=(*state.to_come, news))


def flown_back(
    config: Config, state: State, chain: Chain, now_ms: int, source: str, out: Out
) -> State:
    """UxAS flies the vehicle again: back to its hold or onto its path, or circling if nothing is left."""
    vid = chain.vehicle.id
    ways, air = config.ways(state.zones), state.air(vid)
    back = None if chain.holds else ways.back(chain, air)
    act = way_act(back is not None, chain.item is not None)
    if chain.holds is not None:
        state = state.put(held_again(config, state, chain, now_ms, out))
    elif act == FAIL_TASK and chain.item is not None:
        state = fail(config, state.put(chain), chain.item.task_id, NO_WAY, out)
    elif back is None:
        chain, track = circling(config, state, chain, 0.0, out)
        state = state.put(chain.enter(chain.phase, track, now_ms))
    else:
        entered = chain.enter(chain.phase, back.track, now_ms)
        if chain.phase is Phase.TASK:
            entered = replace(entered, join_m=back.join_m, base_m=back.flown_m, away=True)
        state = state.put(entered)
    if vid in config.instances:
        state = route(state, vid, out)
    return command(config, state, vid, state.epoch(vid), out, source)
