"""Declared failures as the executive has them: it stops a vehicle's mission, and gives up a vehicle that has declared one.

A vehicle whose task was given up under ICAROUS is stopped (`blocked`), and so are all of them when the mission can no
longer be completed (`ended`). A vehicle that has declared a failure does no more tasks. The flight goes on until it has
flown what the mission chooses.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from cratous.core.authority.link_loss import LOITER, OVER
from cratous.core.authority.timeliness import lasted
from cratous.services.flight.dynamics import on_its_ground, stands_at_start
from cratous.services.flight.executive_state import Config, Out, State
from cratous.services.flight.messages import Stop
from cratous.services.icarous.messages import Fails, WithoutLink
from cratous.services.mission.landing import BRAKING_M_S2, on_failure_of
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS
from cratous.spec.mission import Change
from cratous.spec.mission.changes import VEHICLE_FAILED
from cratous.spec.mission.on_failure import Failed
from cratous.spec.records import replace

NOT_YET_MS = 2**53
"""Stands for the time [ms] at which a vehicle has flown what follows its failure, while it still flies it."""
UNANSWERED_MS = 60_000
"""How long the end of the flight waits for a stopped vehicle that has not declared its failure [ms]."""


def asks(state: State, failure: Failed) -> bool:
    """Whether the mission says what is flown after this failure."""
    after = on_failure_of(state.mission)
    return after is not None and failure in after.of


def stop(state: State, vehicle_ids: Iterable[int]) -> State:
    """Stop the missions of these vehicles, but of those that are stopped already or fly no more."""
    gone = {*state.stopping, *dict(state.landed)}
    new = tuple(v for v in vehicle_ids if v not in gone)
    if not new:
        return state
    return replace(state, stopping=(*state.stopping, *new), stopped_ms=state.now_ms)


def repeated(state: State, out: Out) -> None:
    """Tell the vehicles that are stopped and have not declared it yet, since a line may be lost."""
    out += [Stop(vid) for vid in state.stopping if vid not in dict(state.declared)]


def declared(state: State, message: Fails) -> State:
    """A vehicle has declared a failure: it acts by itself from now on, and does no more tasks."""
    vid, now_ms, _, _, reason = message
    chain = state.find(vid)
    if chain is None or vid in dict(state.declared):
        return state
    leg = chain.leg.given_back(now_ms) if chain.suspended else chain.leg
    state = state.put(replace(chain, suspended=True, unlinked=True, holds=None, leg=leg))
    words = f"it has declared a failure at {now_ms / 1000:.2f} s ({reason})"
    news = Change(now_ms, VEHICLE_FAILED, vehicle=vid)
    return replace(
        state,
        landed=(*state.landed, (vid, words)),
        declared=(*state.declared, (vid, NOT_YET_MS)),
        to_come=(*state.to_come, news),
    )


def flies(state: State, message: WithoutLink) -> State:
    """What a vehicle flies by itself. A circle that is chosen, or one at the end, is the last that it flies; one for want
    of a permitted way counts as the last after five look-aheads.
    """
    until_ms = NOT_YET_MS
    chain = state.find(message.vehicle_id)
    if chain is not None and on_its_ground(chain.vehicle, state.air(message.vehicle_id)):
        # it breaks off its roll, if it rolls, and stands
        stops_s = state.air(message.vehicle_id).speed_m_s / BRAKING_M_S2
        until_ms = message.now_ms + math.ceil(1000 * stops_s)
    elif message.mode == OVER or message.mode == message.chosen == LOITER:
        until_ms = message.now_ms
    elif message.mode == LOITER:
        until_ms = message.now_ms + round(1000 * LONGEST_LOOKAHEADS * state.mission.daa.lookahead_s)
    return settled(state, message.vehicle_id, until_ms)


def settled(state: State, vehicle_id: int, until_ms: int) -> State:
    """A vehicle that has declared a failure has flown what follows once this time is over [ms]."""
    was = dict(state.declared)
    if vehicle_id not in was:
        return state
    return replace(state, declared=tuple({**was, vehicle_id: until_ms}.items()))


def busy(state: State) -> set[int]:
    """The vehicles that are stopped, or have declared a failure, and have not flown yet what follows.

    One that has not declared it for UNANSWERED_MS cannot be reached, and is not waited for.
    """
    until = dict(state.declared)
    waits = not lasted(state.stopped_ms, state.now_ms, UNANSWERED_MS)
    known = {*(state.stopping if waits else ()), *until}
    return {v for v in known if not lasted(until.get(v, NOT_YET_MS), state.now_ms, 1)}


def at_the_end(config: Config, state: State) -> State:
    """The state when the mission is about to end incomplete: the vehicles that are stopped first, if any are."""
    if not asks(state, Failed.ENDED):
        return state
    there = {vid: state.find(vid) for vid in config.instances}
    # one that has not taken off stands there already
    return stop(state, (
        vid for vid, chain in there.items()
        if chain is not None and not stands_at_start(chain.vehicle, state.air(vid))
    ))  # fmt: skip
