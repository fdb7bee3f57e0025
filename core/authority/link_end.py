"""The UxAS end of the bridge to one vehicle's ICAROUS, as transition kernels.

ICAROUS announces by SETMOD lines, each with the epoch that it began, who commands; the vehicle reports the state of
its gate. A line is accepted only if the gate agrees. The service keeps one `LinkEnd` per vehicle, passes events to
the kernels, and carries out their answers. Definitions: `spec.authority.link_end`.
"""

from typing import NamedTuple

from cratous.core.authority.gate import Gate, epoch_given
from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import kernel


class LinkEnd(NamedTuple):
    """active: by the last accepted mode ICAROUS commands; epoch: the one of that mode; alive: messages from the
    instance are being received.
    """

    active: bool
    epoch: int
    alive: bool


class Linked(NamedTuple):
    """The end afterwards, and what to do: see the kernels."""

    end: LinkEnd
    act: int


@kernel(implements="authority.link_end.is_after_mode")
def link_mode(end: LinkEnd, gate: Gate, active: bool, epoch: int) -> Linked:
    """A SETMOD has arrived.

    gate: as the vehicle has reported it last; active: the line says that ICAROUS commands, else that it offers
    control; epoch: the one that began with it. act: 0 nothing, 1 suspend what UxAS flies, 2 take the vehicle back,
    also if its takeover was never heard of, 3 report a mode that is superseded, 4 refuse a mode that cannot be true.
    """
    if epoch == end.epoch and active == end.active:
        return Linked(end, 0)
    if not epoch_given(gate, epoch):
        return Linked(end, 4)
    if epoch < gate.epoch or epoch < end.epoch:
        return Linked(end, 3)
    uxas_may = gate.owner == 0 or gate.offered
    if active == uxas_may:
        return Linked(end, 4)
    after = LinkEnd(active, epoch, end.alive)
    if active:
        return Linked(after, 1)
    if end.active or gate.owner != 0:
        return Linked(after, 2)
    return Linked(after, 0)


@kernel(implements="authority.link_end.is_after_sign", nonnegative=("bound",))
def link_sign(end: LinkEnd, event: int, heard: int, now: int, bound: int) -> Linked:
    """A sign of life, or its absence.

    event: 1 a message has arrived, 2 the connection has ended, 3 time has passed; heard: when the last message came
    [ms]; now: the present [ms]; bound: how old it may be [ms]. act: 0 nothing, 1 report that it is heard again, 2
    report that the link is lost, 3 report that it has fallen silent.
    """
    if event == 1:
        if end.alive:
            return Linked(end, 0)
        return Linked(LinkEnd(end.active, end.epoch, True), 1)
    if event == 2:
        return Linked(LinkEnd(end.active, end.epoch, False), 2)
    if event == 3 and end.alive and not in_time(heard, now, bound):
        return Linked(LinkEnd(end.active, end.epoch, False), 3)
    return Linked(end, 0)


@kernel(implements="authority.link_end.is_after_answer")
def suspended_after(suspended: bool, act: int) -> bool:
    """Whether UxAS's own flying of the vehicle is suspended after an answer of `link_mode`."""
    if act == 1:
        return True
    if act == 2:
        return False
    return suspended


@kernel(
    implements="authority.link_end.may_tell",
    restates="the rule of telling; that UxAS commands only what it believes to command is proved of it",
)
def track_is_told(suspended: bool, changed: bool) -> bool:
    """True iff UxAS commands its track now: it flies the vehicle, and the track has changed."""
    return changed and not suspended
