"""The authority cycle of one vehicle's ICAROUS: takeover, offer of control, and withdrawal of the offer.

The gate (`spec.authority.gate`) determines who may command. The instance flies the vehicle exactly while it may
command; it takes over when a conflict is predicted, and offers control when the way back has been free of conflict
for long enough. Each takeover that follows soon after a handback lengthens that required time (hysteresis), so that
authority does not chatter. Milliseconds.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.spec.authority import gate as authority
from cratous.spec.authority.link_end import too_old

MONITOR, AVOID, HANDBACK = 0, 1, 2
"""Modes: UxAS flies; ICAROUS has taken over; ICAROUS commands and offers control."""
NOTHING, OFFER, WITHDRAW, TAKE_OVER = 0, 1, 2, 3
"""Acts of an instance on authority at a heartbeat; the first three as in `spec.authority.gate`."""
MOST_RELAPSES = 4
"""Further relapses no longer increase the count."""


class Instance(NamedTuple):
    """mode; relapses: consecutive takeovers that each followed soon after a handback; handed: control has been handed
    back before, last at handed_ms; free: the way back is free of conflict, and has been since free_ms.
    """

    mode: int
    relapses: int
    handed: bool
    handed_ms: int
    free: bool
    free_ms: int


def is_mode(mode: int) -> bool:
    """It is one of the three modes."""
    return not (mode < MONITOR or mode > HANDBACK)


def steers(cycle: Instance) -> bool:
    """ICAROUS flies the vehicle, as far as the instance knows."""
    return cycle.mode != MONITOR


def same_past(before: Instance, after: Instance) -> bool:
    """The record of takeovers and handbacks is unchanged."""
    handed = after.handed == before.handed and after.handed_ms == before.handed_ms
    return handed and after.relapses == before.relapses


def forgets_the_way(after: Instance) -> bool:
    """The way back does not count as free; its assessment starts anew."""
    return not after.free and after.free_ms == 0


def is_after_notice(before: Instance, commands: bool, now: int, after: Instance) -> bool:
    """An instance flies the vehicle exactly while the gate lets it. If its offer was taken, it records when; if it
    commands without knowing so (after a restart), it enters AVOID. Otherwise nothing changes.
    """
    if steers(before) == commands:
        return after == before
    if commands:
        return after.mode == AVOID and same_past(before, after) and forgets_the_way(after)
    handed = after.handed and after.handed_ms == now and after.relapses == before.relapses
    return not steers(after) and handed and forgets_the_way(after)


def relapsed(before: Instance, now: int, soon: int) -> bool:
    """Control was handed back less than `soon` ago [ms]."""
    return before.handed and now < before.handed_ms + soon


def is_after_watch(
    before: Instance, foreseen: bool, now: int, soon: int, after: Instance, act: int
) -> bool:
    """An instance that does not fly the vehicle takes over if, and only if, a conflict is predicted that it must act
    on. It counts consecutive takeovers that came too soon after a handback.
    """
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
    """The required time after that many relapses, and after one fewer: `least` without relapses, doubled with each
    one, and constant beyond the last that counts.
    """
    if relapses <= 0:
        return asked == least
    if relapses > MOST_RELAPSES:
        return asked == asked_before
    return asked == asked_before + asked_before


def is_free_since(before: Instance, free: bool, now: int, after: Instance) -> bool:
    """The time since which the way back has been continuously free is recorded."""
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
    """An instance that flies the vehicle offers control, or withdraws its offer, when the gate's definitions require
    it, and goes on flying until the offer is taken. asked: how long the way back must have been free [ms].
    """
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
    """The gate carries out the instance's act: it opens an offer, or restricts command to ICAROUS."""
    if act == OFFER:
        return authority.is_offer(before, after)
    if act == NOTHING or act > TAKE_OVER or act < NOTHING:
        return after == before
    return authority.is_takeover(before, after)


def agree(cycle: Instance, gate: authority.State) -> bool:
    """Instance and gate agree: the instance flies iff the gate lets it, and offers iff an offer is open."""
    may = authority.may_command(gate, 1)
    return steers(cycle) == may and (cycle.mode == HANDBACK) == gate.offered
