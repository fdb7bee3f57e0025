"""The UxAS end of the bridge to one vehicle's ICAROUS: what it must accept, do, and not do.

ICAROUS may take a vehicle at any time; UxAS learns of it by SETMOD lines, which are repeated and each carry the epoch
of the gate (`spec.authority.gate`) that began with the change. The vehicle reports the state of its gate; a line that
contradicts it must not be accepted. After a takeover UxAS commands nothing until it hears that control is offered.
"""

from typing import NamedTuple

from cratous.spec.authority.gate import State, may_command, was_given

NOTHING, SUSPEND, TAKE_BACK, OVERTAKEN, REFUSED = 0, 1, 2, 3, 4
"""The response of this end to a mode: nothing; suspend what UxAS flies and record where it was left; fly back and
command it; report a mode that a newer one has superseded; refuse one that cannot be true.
"""

HEARD, ENDED, PASSED = 1, 2, 3
"""Events: a message has arrived; the connection has ended; time has passed."""
SAY_HEARD, SAY_LOST, SAY_SILENT = 1, 2, 3


class End(NamedTuple):
    """active: by the last accepted mode ICAROUS commands; epoch: of that mode; alive: messages are being received."""

    active: bool
    epoch: int
    alive: bool


def believes_uxas(end: End) -> bool:
    """As far as this end has heard, UxAS commands the vehicle."""
    return not end.active


def is_true(gate: State, active: bool, epoch: int) -> bool:
    """The mode is true: the gate is in its epoch, and UxAS may command unless the mode says otherwise."""
    return epoch == gate.epoch and active != may_command(gate, 0)


def is_past(before: End, gate: State, epoch: int) -> bool:
    """The epoch has begun, and a newer one is known to have begun."""
    return was_given(gate, epoch) and (epoch < before.epoch or epoch != gate.epoch)


def is_after_mode(before: End, gate: State, active: bool, epoch: int, after: End, act: int) -> bool:
    """A mode that is already accepted changes nothing. A mode of a past epoch is reported, and one that is neither
    past nor true is refused; neither changes anything. A true one is accepted, and nothing else changes; UxAS then
    releases a vehicle that it may not command, and takes back one that it may command again, whether it had released
    it or is offered a vehicle whose takeover it never heard of.
    """
    if active == before.active and epoch == before.epoch:
        return after == before and act == NOTHING
    if is_past(before, gate, epoch):
        return after == before and act == OVERTAKEN
    if not is_true(gate, active, epoch):
        return after == before and act == REFUSED
    believed = after == End(active, epoch, before.alive)
    if not believes_uxas(after):
        return believed and act == SUSPEND
    if not believes_uxas(before) or gate.offered:
        return believed and act == TAKE_BACK
    return believed and act == NOTHING


def too_old(heard: int, now: int, bound: int) -> bool:
    """The last message is older than the bound, or none has arrived by now."""
    return now < heard or now > heard + bound


def is_after_sign(
    before: End, event: int, heard: int, now: int, bound: int, after: End, act: int
) -> bool:
    """A peer that is heard is alive; one whose connection has ended or whose last message is too old is not. Each
    change is reported once, the end of a connection each time. No sign of life changes who commands.
    """
    same = after.active == before.active and after.epoch == before.epoch
    if event == HEARD:
        return same and after.alive and (act == SAY_HEARD) == (not before.alive) and act <= 1
    if event == ENDED:
        return same and not after.alive and act == SAY_LOST
    if event == PASSED and before.alive and too_old(heard, now, bound):
        return same and not after.alive and act == SAY_SILENT
    return after == before and act == NOTHING


def is_after_answer(suspended: bool, act: int, after: bool) -> bool:
    """After SUSPEND it is suspended, after TAKE_BACK it is not, and no other answer changes anything."""
    if act == SUSPEND:
        return after
    if act == TAKE_BACK:
        return not after
    return after == suspended


def may_tell(suspended: bool, changed: bool) -> bool:
    """UxAS commands nothing while it is suspended, and does not repeat an unchanged command."""
    return not (suspended or not changed)
