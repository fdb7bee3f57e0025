"""ICAROUS takes a vehicle and offers it back: what becomes of its chain."""

from __future__ import annotations

from dataclasses import replace

from cratous.core.authority.link_end import suspended_after
from cratous.services.flight.ahead import leaving_m
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.executive_state import Config, Out, State
from cratous.services.flight.messages import Left, Suspend, TakeBack
from cratous.services.flight.passing import progress
from cratous.services.flight.telling import command, route
from cratous.spec.mission import Position

NAME = "uxas/ics"
"""The sender of what the bridge has led to."""


def suspend(state: State, message: Suspend, out: Out) -> State:
    """ICAROUS has taken over: where the path was left, if a task was active."""
    chain = state.chain(message.vehicle_id)
    was, chain = (
        chain,
        replace(chain, suspended=suspended_after(chain.suspended, message.act)),
    )
    left = _resume_point(chain)
    if left is not None:
        out.append(Left(message.vehicle_id, left))
        if not was.suspended and not was.away:
            note = f"left the path at {chain.path_flown_m():.0f} m"
            said = progress(chain, message.now_ms, "Suspended", note, chain.served())
            out.append(said._replace(source=NAME))
    return state.put(chain)


def _resume_point(chain: Chain) -> Position | None:
    """Where the path was left, if a task was active: the sensor misses nothing."""
    return chain.track.at(leaving_m(chain)) if chain.phase is Phase.TASK else None


def take_back(config: Config, state: State, message: TakeBack, out: Out) -> State:
    """ICAROUS hands back: route to the resume point, then along the rest of the path."""
    vid = message.vehicle_id
    chain = state.chain(vid)
    chain = replace(chain, suspended=suspended_after(chain.suspended, message.act))
    back = config.ways(state.zones).back(chain, state.air(vid))
    chain = chain.enter(chain.phase, back.track, message.now_ms)
    if chain.phase is Phase.TASK:
        chain = replace(chain, join_m=back.join_m, base_m=back.flown_m, away=True)
    state = route(state.put(chain), vid, out)
    return command(config, state, vid, message.epoch, out, NAME)
