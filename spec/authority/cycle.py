"""The cycle of one vehicle's ICAROUS: when it takes over, offers control back, and withdraws the offer.

The gate (`spec.authority.gate`) says who may command. The instance steers exactly while it may; it takes
over when a conflict is foreseen, and offers control when the way back has been free of conflict for long
enough. The more often it had to take over soon after it had handed back, the longer that is, so that
authority does not chatter. Milliseconds.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.authority import gate as authority
from cratous.spec.authority.link_end import too_old

MONITOR, AVOID, HANDBACK = 0, 1, 2
"""UxAS flies; ICAROUS has taken over; ICAROUS commands and offers control."""
NOTHING, OFFER, WITHDRAW, TAKE_OVER = 0, 1, 2, 3
"""What an instance does with authority at a heartbeat; the first three as in `spec.authority.gate`."""
MOST_RELAPSES = 4
"""More relapses than this count as this many."""


class Instance(NamedTuple):
    """mode; relapses: takeovers that each followed soon after a handback; handed: control has been
    handed back before, last at handed_ms; free: the way back is free, and has been since free_ms."""

    mode: int
    relapses: int
    handed: bool
    handed_ms: int
    free: bool
    free_ms: int


def is_mode(mode: int) -> bool:
    """It is one of the three."""
    return not (mode < MONITOR or mode > HANDBACK)


def steers(cycle: Instance) -> bool:
    """ICAROUS flies the vehicle, as far as the instance is concerned."""
    return cycle.mode != MONITOR


def same_past(before: Instance, after: Instance) -> bool:
    """What it remembers of takeovers and handbacks is the same."""
    handed = after.handed == before.handed and after.handed_ms == before.handed_ms
    return handed and after.relapses == before.relapses


def forgets_the_way(after: Instance) -> bool:
    """The way back does not count as free; it is looked at anew."""
    return not after.free and after.free_ms == 0


def is_after_notice(before: Instance, commands: bool, now: int, after: Instance) -> bool:
    """An instance steers exactly while the gate lets it. One whose offer was taken remembers when; one
    that commands and does not know it, having been started anew, avoids. Else nothing changes."""
    if steers(before) == commands:
        return after == before
    if commands:
        return after.mode == AVOID and same_past(before, after) and forgets_the_way(after)
    handed = after.handed and after.handed_ms == now and after.relapses == before.relapses
    return not steers(after) and handed and forgets_the_way(after)


def relapsed(before: Instance, now: int, soon: int) -> bool:
    """Control was handed back less than `soon` ago."""
    return before.handed and now < before.handed_ms + soon


def is_after_watch(
    before: Instance, foreseen: bool, now: int, soon: int, after: Instance, act: int
) -> bool:
    """An instance that does not steer takes over if a conflict is foreseen that it must act on, and
    only then. It counts how many times in a row that came too soon after a handback."""
    if steers(before) or not foreseen:
        return after == before and act == NOTHING
    if relapsed(before, now, soon):
        one_more = after.relapses == before.relapses + 1 and after.relapses <= MOST_RELAPSES
        no_more = after.relapses == MOST_RELAPSES and before.relapses >= MOST_RELAPSES
        counted = one_more or no_more
    else:
        counted = after.relapses == 0
    handed = after.handed == before.handed and after.handed_ms == before.handed_ms
    remembers = counted and handed and forgets_the_way(after)
    return act == TAKE_OVER and after.mode == AVOID and remembers


def is_patience(relapses: int, least: int, asked: int, asked_before: int) -> bool:
    """How long is asked for after that many relapses, and after one less: without any `least`, with
    each the double, and no longer after the last that counts."""
    if relapses <= 0:
        return asked == least
    if relapses > MOST_RELAPSES:
        return asked == asked_before
    return asked == asked_before + asked_before


def is_free_since(before: Instance, free: bool, now: int, after: Instance) -> bool:
    """It is remembered since when the way back has been free without a break."""
    if not free:
        return forgets_the_way(after)
    begun = after.free_ms == now
    goes_on = after.free_ms == before.free_ms
    return after.free and ((before.free and goes_on) or (not before.free and begun))


def is_after_flight(
    before: Instance,
    free: bool,
    heard: int,
    now: int,
    bound: int,
    asked: int,
    after: Instance,
    act: int,
) -> bool:
    """An instance that steers offers control, or withdraws its offer, when the gate's definitions say
    so, and goes on steering until it is taken. asked: how long the way back must have been free."""
    if not steers(before):
        return after == before and act == NOTHING
    offered = before.mode == HANDBACK
    long = free and not now < after.free_ms + asked
    linked = not too_old(heard, now, bound)
    remembers = same_past(before, after) and is_free_since(before, free, now, after)
    if authority.must_withdraw(offered, free):
        return act == WITHDRAW and after.mode == AVOID and remembers
    if authority.may_offer(offered, free, long, linked):
        return act == OFFER and after.mode == HANDBACK and remembers
    return act == NOTHING and after.mode == before.mode and remembers


def is_after_wish(before: authority.State, act: int, after: authority.State) -> bool:
    """The gate does what the instance wants: it opens an offer, or lets ICAROUS alone command."""
    if act == OFFER:
        return authority.is_offer(before, after)
    if act == NOTHING or act > TAKE_OVER or act < NOTHING:
        return after == before
    return authority.is_takeover(before, after)


def agree(cycle: Instance, gate: authority.State) -> bool:
    """Instance and gate mean the same: it steers iff the gate lets it, and offers iff an offer is open."""
    may = authority.may_command(gate, 1)
    return steers(cycle) == may and (cycle.mode == HANDBACK) == gate.offered
