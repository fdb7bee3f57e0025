"""The authority cycle of one vehicle's ICAROUS: monitor, avoid, hand back. Transition kernels.

In MONITOR (0) UxAS flies and the path ahead is monitored; in AVOID (1) ICAROUS has taken over; in HANDBACK (2) it
goes on commanding and offers control. At each heartbeat the instance first reads its gate, then either monitors or
flies. Definitions: `spec.authority.cycle`.
"""

from typing import NamedTuple

from cratous.core.authority.gate import Gate, gate_offer, gate_takeover, handback
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.kernel import kernel


class Cycle(NamedTuple):
    """mode: see above; relapses: takeovers that each followed soon after a handback, at most 4;
    handed: control has been handed back before, last at handed_ms [ms]; free: the way back has been
    free of predicted conflict since free_ms [ms]."""

    mode: int
    relapses: int
    handed: bool
    handed_ms: int
    free: bool
    free_ms: int


class Cycled(NamedTuple):
    """The cycle afterwards, and the act on authority: 0 nothing, 1 offer it, 2 withdraw the offer, 3 take over."""

    cycle: Cycle
    act: int


@kernel(implements="authority.cycle.is_after_notice")
def cycle_begun(cycle: Cycle, commands: bool, now: int) -> Cycle:
    """A heartbeat begins. commands: ICAROUS may command, by the gate; now: [ms]."""
    if commands:
        if cycle.mode == 0:
            return Cycle(1, cycle.relapses, cycle.handed, cycle.handed_ms, False, 0)
        return cycle
    if cycle.mode == 0:
        return cycle
    return Cycle(0, cycle.relapses, True, now, False, 0)


@kernel(implements="authority.cycle.is_after_watch", nonnegative=("soon",))
def cycle_watched(cycle: Cycle, foreseen: bool, now: int, soon: int) -> Cycled:
    """UxAS flies. foreseen: a conflict is predicted on which ICAROUS must act; now: [ms]; soon: a takeover less than
    this after a handback is a relapse [ms], >= 0.
    """
    if cycle.mode != 0 or not foreseen:
        return Cycled(cycle, 0)
    relapses = 0
    if cycle.handed and not lasted(cycle.handed_ms, now, soon):
        relapses = min(cycle.relapses + 1, 4)
    return Cycled(Cycle(1, relapses, cycle.handed, cycle.handed_ms, False, 0), 3)


@kernel(implements="authority.cycle.is_patience", nonnegative=("least",))
def patience(relapses: int, least: int) -> int:
    """How long the way back must have been free [ms]: doubled with each relapse, up to four.

    least: without a relapse [ms], >= 0, at most 2^56.
    """
    if relapses <= 0:
        return least
    if relapses == 1:
        return 2 * least
    if relapses == 2:
        return 4 * least
    if relapses == 3:
        return 8 * least
    return 16 * least


@kernel(implements="authority.cycle.is_after_flight", nonnegative=("bound", "least"))
def cycle_flown(cycle: Cycle, free: bool, heard: int, now: int, bound: int, least: int) -> Cycled:
    """ICAROUS flies. free: the way back is free of predicted conflict now.

    heard: when UxAS was last heard [ms]; now: [ms]; bound: how long it may be silent [ms], >= 0; least: as for
    `patience`.
    """
    if cycle.mode == 0:
        return Cycled(cycle, 0)
    since = 0
    if free:
        since = now
        if cycle.free:
            since = cycle.free_ms
    long = free and lasted(since, now, patience(cycle.relapses, least))
    act = handback(cycle.mode == 2, free, long, in_time(heard, now, bound))
    mode = cycle.mode
    if act == 1:
        mode = 2
    if act == 2:
        mode = 1
    return Cycled(Cycle(mode, cycle.relapses, cycle.handed, cycle.handed_ms, free, since), act)


@kernel(implements="authority.cycle.is_after_wish")
def gate_wished(gate: Gate, act: int) -> Gate:
    """The gate after an instance's act on authority. act: as in `Cycled`."""
    if act == 1:
        return gate_offer(gate)
    if act == 2 or act == 3:
        return gate_takeover(gate)
    return gate
