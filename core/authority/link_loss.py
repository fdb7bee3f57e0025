"""Flight of one vehicle while UxAS is not heard. Transition kernels.

LINKED (0): UxAS is heard. FINISH (1): the known path is flown to its end. LOITER (2): a circle is flown. RETURN (3):
a path to a named place is flown. OVER (4): the chosen path has been flown to its end, and a circle is flown there.
LAND (5): a path to a landing site is flown. FINAL (6): the final descent to the ground is flown. LANDED (7): the
vehicle is on the ground. At each heartbeat the instance first determines its mode, then takes the vehicle over or
flies it (`core.authority.cycle`). Definitions: `spec.authority.link_loss`.
"""

from typing import NamedTuple

from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import kernel

LINKED, FINISH, LOITER, RETURN, OVER, LAND, FINAL, LANDED = 0, 1, 2, 3, 4, 5, 6, 7


class Loss(NamedTuple):
    """mode: see above; since_ms: when it began [ms]."""

    mode: int
    since_ms: int


class LossStep(NamedTuple):
    """The mode afterwards, and the event: 0 nothing, 1 the chosen mode begins, 2 it is not permitted and a circle is
    flown, 3 it has been flown to its end, 4 UxAS is heard again, 5 the final descent begins, 6 the ground is reached.
    """

    loss: Loss
    act: int


@kernel(implements="authority.link_loss.is_after_heartbeat", nonnegative=("bound",))
def loss_step(
    loss: Loss, chosen: int, heard: int, now: int, bound: int, permitted: bool, ended: bool
) -> LossStep:
    """A heartbeat of the instance.

    chosen: the mission's choice without the link, 1 to 3 or 5; heard: when UxAS was last heard [ms]; now: [ms];
    bound: how long it may be silent [ms], >= 0; permitted: the path of the chosen mode is permitted from here; ended:
    the vehicle is at the end of what it flies.
    """
    if loss.mode == 7:
        return LossStep(loss, 0)
    if loss.mode == 6:
        if ended:
            return LossStep(Loss(7, now), 6)
        return LossStep(loss, 0)
    if in_time(heard, now, bound):
        if loss.mode == 0:
            return LossStep(loss, 0)
        return LossStep(Loss(0, now), 4)
    if loss.mode == 4:
        return LossStep(loss, 0)
    if loss.mode == chosen:
        if chosen == 2:
            return LossStep(loss, 0)
        if ended and chosen != 5:
            return LossStep(Loss(4, now), 3)
        if ended and permitted:
            return LossStep(Loss(6, now), 5)
        if permitted:
            return LossStep(loss, 0)
        return LossStep(Loss(2, now), 2)
    if chosen == 2 or permitted:
        return LossStep(Loss(chosen, now), 1)
    if loss.mode == 2:
        return LossStep(loss, 0)
    return LossStep(Loss(2, now), 2)


@kernel(
    implements="authority.link_loss.must_fly",
    restates="why ICAROUS has a vehicle; that it has it within a heartbeat of a loss is proved of it",
)
def loss_takes(loss: Loss, foreseen: bool) -> bool:
    """True iff ICAROUS has to command the vehicle. foreseen: a conflict is predicted on which it must act."""
    return foreseen or loss.mode != 0


@kernel(
    implements="authority.link_loss.may_go_back",
    restates="when a vehicle may go back; that nothing is offered without the link is proved of it",
)
def loss_lets_go(loss: Loss, free: bool) -> bool:
    """True iff the vehicle may go back to UxAS. free: the way back is free of predicted conflict."""
    return free and loss.mode == 0
