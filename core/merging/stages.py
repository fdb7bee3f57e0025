"""The stages of a vehicle that merges at a fix, as transition kernels. Definitions: `spec.merging.stages`.

AWAY (0): the fix is not on its route, or too far ahead. ASKING (1): it requests a slot while UxAS flies on.
IN_SLOT (2): ICAROUS flies it to be at the fix at its slot. HOLDING (3): ICAROUS flies a circle until it may continue.
"""

from cratous.core.kernel import kernel

AWAY, ASKING, IN_SLOT, HOLDING = 0, 1, 2, 3


@kernel(implements="merging.stages.is_after_heartbeat")
def merge_step(
    stage: int, near: bool, inside: bool, slotted: bool, early: bool, entered: bool
) -> int:
    """The stage after a heartbeat.

    stage: the stage before; near: the fix is ahead, and the vehicle in the coordination zone; inside: in the schedule
    zone; slotted: a majority has granted a slot for the present request; early: at any speed the vehicle would
    arrive before its slot; entered: in the entry zone, too near to wait.
    """
    if not near:
        return 0
    if slotted and (entered or not early):
        return 2
    if slotted or inside or stage == 3:
        return 3
    return 1


@kernel(implements="merging.stages.must_fly")
def merging_takes(stage: int, foreseen: bool) -> bool:
    """True iff ICAROUS must have authority. foreseen: there is another reason for it."""
    return foreseen or stage == 2 or stage == 3


@kernel(implements="merging.stages.may_go_back")
def merging_lets_go(stage: int, free: bool) -> bool:
    """True iff the vehicle may go back to UxAS. free: nothing else prevents it."""
    return free and stage != 2 and stage != 3
