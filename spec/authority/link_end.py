"""The UxAS end of the bridge to one vehicle's ICAROUS: what it must believe, do, and leave.

ICAROUS may take a vehicle at any time; UxAS learns of it by SETMOD lines, each with the epoch of the
gate (`spec.authority.gate`) that began with it, sent again and again. The vehicle reports how its gate
stands; a line that says otherwise is nobody's to believe. Until it hears that control is offered, UxAS
keeps its hands off the vehicle.
"""

from typing import NamedTuple

from cratous.spec.authority.gate import State, may_command, was_given

NOTHING, SUSPEND, TAKE_BACK, OVERTAKEN, REFUSED = 0, 1, 2, 3, 4
"""What this end does about a mode: nothing; suspend what UxAS flies and tell where it was left; fly
back and command it; report a mode that a newer one has overtaken; refuse one that cannot be true."""

HEARD, ENDED, PASSED = 1, 2, 3
"""A message has come; the connection has ended; time has passed."""
SAY_HEARD, SAY_LOST, SAY_SILENT = 1, 2, 3


class End(NamedTuple):
    """active: by the last accepted mode ICAROUS commands; epoch: of that mode; alive: it is heard."""

    active: bool
    epoch: int
    alive: bool


def believes_uxas(end: End) -> bool:
    """As far as this end has heard, UxAS commands the vehicle."""
    return not end.active


def is_true(gate: State, active: bool, epoch: int) -> bool:
    """What a mode says is so: the gate is in its epoch, and UxAS may command unless it says otherwise."""
    return epoch == gate.epoch and active != may_command(gate, 0)


def is_past(before: End, gate: State, epoch: int) -> bool:
    """The epoch was given, and a newer one is known to have begun."""
    return was_given(gate, epoch) and (epoch < before.epoch or epoch != gate.epoch)


def is_after_mode(before: End, gate: State, active: bool, epoch: int, after: End, act: int) -> bool:
    """The mode that is believed already changes nothing. One that is past is reported, and one that is
    neither past nor true is refused; neither changes anything. A true one is believed, and that alone
    changes; UxAS then lets go of a vehicle that it may not command, and takes back one that it may
    command again, be it that it has let go or that it is offered what it never knew was taken."""
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
    """The last message came longer ago than the bound, or none has come by now."""
    return now < heard or now > heard + bound


def is_after_sign(
    before: End, event: int, heard: int, now: int, bound: int, after: End, act: int
) -> bool:
    """Who is heard is alive, one whose connection has ended or whose last message is too old is not;
    each change of that is told once, the end of a connection whenever it ends. No sign of life
    changes who commands."""
    same = after.active == before.active and after.epoch == before.epoch
    if event == HEARD:
        return same and after.alive and (act == SAY_HEARD) == (not before.alive) and act <= 1
    if event == ENDED:
        return same and not after.alive and act == SAY_LOST
    if event == PASSED and before.alive and too_old(heard, now, bound):
        return same and not after.alive and act == SAY_SILENT
    return after == before and act == NOTHING


def is_after_answer(suspended: bool, act: int, after: bool) -> bool:
    """Who is to suspend is suspended afterwards, who takes back is not, and no other answer changes
    anything."""
    if act == SUSPEND:
        return after
    if act == TAKE_BACK:
        return not after
    return after == suspended


def may_tell(suspended: bool, changed: bool) -> bool:
    """UxAS commands nothing while it is suspended, and what it has commanded already not again."""
    return not (suspended or not changed)
