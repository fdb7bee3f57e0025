"""What a vehicle does on its way over a merge fix: it asks for a slot, is flown to be there in time, or holds outside."""

from __future__ import annotations

AWAY, ASKING, IN_SLOT, HOLDING = 0, 1, 2, 3
"""The fix is not on its way, or too far ahead; it asks for a slot; it is flown so as to be there at its time; a circle is
flown until it may go on."""


def is_stage(stage: int) -> bool:
    """It is one of the four."""
    return not (stage < AWAY or stage > HOLDING)


def goes_on(slotted: bool, early: bool, entered: bool) -> bool:
    """It may fly on: it has a slot, and is not too early for it at any speed, or too near to wait."""
    return slotted and (entered or not early)


def is_after_heartbeat(
    before: int, near: bool, inside: bool, slotted: bool, early: bool, entered: bool, after: int
) -> bool:
    """near: the fix is ahead, and nearer than where it is asked for a slot; inside: nearer than where it is flown by
    its slot; entered: too near to wait."""
    if not near:
        return after == AWAY
    if goes_on(slotted, early, entered):
        return after == IN_SLOT
    if slotted or inside or before == HOLDING:
        return after == HOLDING
    return after == ASKING


def must_fly(stage: int, foreseen: bool) -> bool:
    """ICAROUS has a reason to have the vehicle: another one, or it flies by its slot or holds."""
    return foreseen or not (stage < IN_SLOT or stage > HOLDING)


def may_go_back(stage: int, free: bool) -> bool:
    """UxAS may be offered the vehicle: the way back is free, and it neither flies by its slot nor holds."""
    return free and (stage < IN_SLOT or stage > HOLDING)
