"""The stages of a vehicle that merges at a fix: it requests a slot, is flown to its slot, or holds outside."""

from __future__ import annotations

AWAY, ASKING, IN_SLOT, HOLDING = 0, 1, 2, 3
"""AWAY: the fix is not on its route, or too far ahead; ASKING: it requests a slot; IN_SLOT: it is flown to arrive at
its slot; HOLDING: it flies a circle until it may continue.
"""


def is_stage(stage: int) -> bool:
    """The number is that of one of the four stages."""
    return not (stage < AWAY or stage > HOLDING)


def goes_on(slotted: bool, early: bool, entered: bool) -> bool:
    """The vehicle may continue: it has a slot, and can be late enough for it, or is too near to wait."""
    return slotted and (entered or not early)


def is_after_heartbeat(
    before: int, near: bool, inside: bool, slotted: bool, early: bool, entered: bool, after: int
) -> bool:
    """The stage after a heartbeat.

    near: the fix is ahead, and the vehicle in the coordination zone; inside: in the schedule zone; slotted: it has a
    slot; early: at any speed it would arrive before its slot; entered: in the entry zone, too near to wait.
    """
    if not near:
        return after == AWAY
    if goes_on(slotted, early, entered):
        return after == IN_SLOT
    if slotted or inside or before == HOLDING:
        return after == HOLDING
    return after == ASKING


def must_fly(stage: int, foreseen: bool) -> bool:
    """ICAROUS must have authority: the vehicle is flown to its slot, holds, or there is another reason."""
    return foreseen or not (stage < IN_SLOT or stage > HOLDING)


def may_go_back(stage: int, free: bool) -> bool:
    """UxAS may be offered the vehicle: the way back is free, and it is neither flown to its slot nor holding."""
    return free and (stage < IN_SLOT or stage > HOLDING)
