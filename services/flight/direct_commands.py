"""Operator commands to a single vehicle: hold at a place, and resume the plan.

The plan does not change. A vehicle that holds interrupts its item, as under ICAROUS, and continues it from
there when it resumes; other vehicles wait for it as usual. A command is refused, with the reason, if UxAS
does not have the vehicle or no route there keeps the zones (kernels by `first_bad_leg`); the vehicle then
flies on unchanged. The command passes the vehicle's gate like every other.
"""

from __future__ import annotations

from collections.abc import Sequence

from cratous.core.authority.link_end import track_is_told
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import on_its_ground
from cratous.services.flight.executive_outputs import command
from cratous.services.flight.executive_state import Config, Out, State
from cratous.services.flight.hold_paths import into, pose_of
from cratous.services.flight.interruption import EXECUTIVE, flown_back
from cratous.services.flight.messages import Say
from cratous.services.flight.notices import mission_change
from cratous.services.flight.task_transitions import next_item, progress
from cratous.services.mission.availability import absent
from cratous.spec.mission import Change
from cratous.spec.mission.changes import HoldCommand, words
from cratous.spec.records import replace

NAME = "uxas"
"""Sender of messages about the mission."""
REFUSED = "refused: "


def obey(config: Config, state: State, due: Sequence[Change], out: Out) -> State:
    """Carry out the commands that are due, in order, and announce the result of each."""
    for change in due:
        done: Out = []
        why = _not_commanded(config, state, change.vehicle)
        if why:
            after, answer = state, REFUSED + why
        elif isinstance(change, HoldCommand):
            after, answer = _hold(config, state, change, done)
        else:
            after, answer = _resume(config, state, change.vehicle, done)
        out.append(Say(mission_change(state.now_ms, words(change), answer), NAME))
        out.extend(done)
        state = after
    return state


def _not_commanded(config: Config, state: State, vehicle_id: int) -> str:
    """Why UxAS cannot command a vehicle at present; "" if it can."""
    away = {**absent(config.mission, state.now_ms), **dict(state.landed)}
    if vehicle_id in away:
        return away[vehicle_id]
    chain = state.chain(vehicle_id)
    if on_its_ground(chain.vehicle, state.air(vehicle_id)):
        return "it has not taken off"
    if chain.unlinked:
        return "it is not heard"
    return "" if track_is_told(chain.suspended, True) else "ICAROUS has it"


def _hold(config: Config, state: State, asked: HoldCommand, out: Out) -> tuple[State, str]:
    """Fly to the hold. Returns the state and the answer, in words."""
    chain, air = state.chain(asked.vehicle), state.air(asked.vehicle)
    flies = replace(chain, speed_m_s=chain.vehicle.speed_m_s)
    found = into(config.ways(state.zones), flies, air, pose_of(asked, air))
    if found.track is None:
        return state, REFUSED + found.why
    if chain.phase is Phase.TASK and not chain.away:
        note = f"left the path at {chain.path_flown_m():.0f} m"
        out.append(progress(chain, state.now_ms, "Suspended", note, chain.served()))
    left = chain if chain.holds is None else chain.left
    holds = replace(flies, holds=found.pose, left=left)
    state = state.put(holds.enter(Phase.DONE, found.track, state.now_ms))
    answer = f"it circles through a place {found.way_m:.0f} m of flight from here, until it resumes"
    return command(config, state, asked.vehicle, state.epoch(asked.vehicle), out), answer


def _resume(config: Config, state: State, vehicle_id: int, out: Out) -> tuple[State, str]:
    """Resume the plan: with the interrupted item, or with the next one of the present plan."""
    chain, now_ms = state.chain(vehicle_id), state.now_ms
    if chain.holds is None:
        return state, REFUSED + "it flies by its plan already"
    on = chain.by_plan()
    if on is not chain:
        state = flown_back(config, state, _let_go(chain, on), now_ms, EXECUTIVE, out)
        return state, "it goes on where it left"
    free = replace(chain, holds=None, left=None, k=chain.k - 1)
    state = next_item(config, state.put(free), free, now_ms, out)
    state = command(config, state, vehicle_id, state.epoch(vehicle_id), out)
    return state, "it flies on by the plan that there is now"


def _let_go(chain: Chain, on: Chain) -> Chain:
    """The chain as it was interrupted, with the vehicle's present version counts and link state."""
    return replace(
        on, vehicle=chain.vehicle, version=chain.version, route_version=chain.route_version,
        told_version=chain.told_version, suspended=chain.suspended, unlinked=chain.unlinked, leg=chain.leg,
    )  # fmt: skip
