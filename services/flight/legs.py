"""Legs under ICAROUS for too long: their tasks fail by name, so that nothing waits for ever.

A leg is the way to an item and the item's path, across re-planning. The number of takeovers on it and the
total time under ICAROUS are bounded; the kernel `leg_given_up` decides. The task then fails as blocked, with
the last reason of ICAROUS, and the vehicle goes on to its next one. A vehicle without further tasks circles
where it is, so that it can be handed back wherever that is permitted.
"""

from __future__ import annotations

from cratous.core.executive.steps import leg_given_up
from cratous.services.flight import failing
from cratous.services.flight.chain import Chain
from cratous.services.flight.executive_outputs import route
from cratous.services.flight.executive_state import Config, Out, State
from cratous.services.flight.task_transitions import circling, fail
from cratous.services.mission.landing import MAX_ACCELERATION_M_S2
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS, MOST_TAKEOVERS
from cratous.services.mission.merging import merging_ms
from cratous.services.mission.take_off import take_off_ms
from cratous.spec.mission import Vehicle
from cratous.spec.mission.on_failure import Failed
from cratous.spec.records import replace

ANEW_MS = 10_000
"""A vehicle without tasks gets a new circle at its position after this long under ICAROUS [ms]."""


def give_up(config: Config, state: State, out: Out) -> State:
    """Fail the items whose legs exceed the bounds, and send ICAROUS the new routes of their vehicles."""
    avoiding_ms = round(1000 * LONGEST_LOOKAHEADS * state.mission.daa.lookahead_s)
    for vid in config.instances:
        chain = state.find(vid)
        if chain is None or chain.unlinked or chain.holds or vid in dict(state.landed):
            continue
        if vid in state.stopping:
            continue
        under_ms = chain.leg.flown_ms(chain.suspended, state.now_ms)
        # a take-off does not count as time of avoidance
        under_ms -= take_off_of(state, chain.vehicle)
        # nor does the time for its slot at a merge fix
        longest_ms = avoiding_ms + merging_ms(state.mission, vid)
        if chain.item is None:
            if chain.suspended and leg_given_up(0, 0, under_ms, ANEW_MS):
                state = _circle_here(config, state, chain, out)
        elif leg_given_up(chain.leg.takeovers, MOST_TAKEOVERS, under_ms, longest_ms):
            state = fail(config, state, chain.item.task_id, _blocked(chain, under_ms), out)
            if failing.asks(state, Failed.BLOCKED):
                state = failing.stop(state, (vid,))
            elif state.chain(vid).suspended:
                state = route(state, vid, out)
    return state


def take_off_of(state: State, vehicle: Vehicle) -> int:
    """Duration of a take-off that is permitted at once, of a vehicle that UxAS has not had yet [ms]; else 0."""
    if state.epoch(vehicle.id) != 0:
        return 0
    return take_off_ms(vehicle, MAX_ACCELERATION_M_S2, state.mission.simulation.heartbeat_ms)


def _blocked(chain: Chain, under_ms: int) -> str:
    """Why a leg is given up, in words."""
    leg, times = chain.leg, "once" if chain.leg.takeovers == 1 else f"{chain.leg.takeovers} times"
    last = leg.because or "what it did not say"
    return (
        f"blocked: ICAROUS took vehicle {chain.vehicle.id} over {times} on this leg and flew it for"
        f" {under_ms / 1000:g} s, last because of {last}"
    )


def _circle_here(config: Config, state: State, chain: Chain, out: Out) -> State:
    chain, track = circling(config, state, chain, 0.0, out)
    chain = chain.enter(chain.phase, track, state.now_ms)
    state = state.put(replace(chain, leg=chain.leg.begun_anew(state.now_ms)))
    return route(state, chain.vehicle.id, out)
