"""All events that affect authority over a vehicle that meets any number of intruders, with the counters kept of
them."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.authority.cycle import (
    Cycle,
    cycle_begun,
    cycle_flown,
    cycle_watched,
    gate_wished,
)
from cratous.core.authority.gate import Gate, gate_accepts, gate_after
from cratous.core.authority.link_end import LinkEnd, link_mode, suspended_after
from cratous.core.authority.link_loss import Loss, loss_takes
from cratous.core.permit.encounter import (
    Encounter,
    encounter_looked,
    encounter_resumed,
    encounter_watched,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.vehicles import counts
from cratous.spec.authority import cycle as instance
from cratous.spec.system import counting

LOOK, RESUME, BEAT, COMMAND, LINE, ITEM = range(6)
"""Kinds of events; any other number is no event."""


class Counted(NamedTuple):
    """Gate, instance and UxAS's end, whether UxAS's flying is suspended, and the counters of `spec.system.counting`."""

    gate: Gate
    cycle: Cycle
    end: LinkEnd
    suspended: Any
    tally: counting.Tally


class Event(NamedTuple):
    """kind: an intruder is looked at; the resumed course is permitted against it or not; a heartbeat of ICAROUS,
    whose takeover names the intruder; a command reaches the gate; a SETMOD line reaches UxAS, with a report of the
    gate from when there had been `made` epochs of ICAROUS alone; another item begins.

    met: the intruder's encounter; allowed, until, foreseen: inputs of its kernels; zone: there is another reason to
    take over; loss: the mode of link loss; free, heard, now, bound, least, soon: inputs of the cycle; sender, epoch:
    of the command; says, began: of the line.
    """

    kind: Any
    met: Encounter
    allowed: Any
    until: Any
    foreseen: Any
    zone: Any
    loss: Loss
    free: Any
    heard: Any
    now: Any
    bound: Any
    least: Any
    soon: Any
    sender: Any
    epoch: Any
    report: Gate
    made: Any
    says: Any
    began: Any


def any_counted(c: Claim) -> Counted:
    """An arbitrary state, with numbers of any size."""
    gate = Gate(c.whole("owner"), c.whole("gate_epoch"), c.boolean("offered"))
    cycle = Cycle(
        c.whole("mode"), c.whole("relapses"), c.boolean("handed"), c.whole("handed_ms"),
        c.boolean("free"), c.whole("free_ms"),
    )  # fmt: skip
    end = LinkEnd(c.boolean("active"), c.whole("end_epoch"), c.boolean("alive"))
    names = counting.Tally._fields[1:]
    tally = counting.Tally(c.boolean("counted"), *[c.whole(f"tally_{n}") for n in names])
    return Counted(gate, cycle, end, c.boolean("suspended"), tally)


def first_counted() -> Counted:
    """The initial state: UxAS flies to its first item, and nobody has been met."""
    tally = counting.Tally(True, *[0] * (len(counting.Tally._fields) - 1))
    return Counted(
        Gate(0, 0, False), Cycle(0, 0, False, 0, False, 0), LinkEnd(False, 0, True), False, tally
    )


def any_event(c: Claim) -> Event:
    """An arbitrary event."""
    met = Encounter(
        c.whole("met_takeovers"), c.whole("met_surprises"), c.whole("met_ended"),
        c.boolean("avoiding"), c.boolean("permitted"), c.whole("met_until"),
    )  # fmt: skip
    loss = Loss(c.whole("mode_without"), c.whole("since"))
    heard, now, bound, least, soon = (
        c.whole(n) for n in ("heard", "now", "bound", "least", "soon")
    )
    report = Gate(c.whole("report_owner"), c.whole("report_epoch"), c.boolean("report_offered"))
    return Event(
        c.whole("happens"), met, c.boolean("allowed"), c.whole("until"), c.boolean("foreseen"),
        c.boolean("zone"), loss, c.boolean("way_free"), heard, now, bound, least, soon,
        c.whole("sender"), c.whole("command_epoch"), report, c.whole("report_made"),
        c.boolean("says"), c.whole("began"),
    )  # fmt: skip


def each_event(c: Claim, one: Event) -> Any:
    """Condition on every event: numbers are within counting range, and the report is consistent with how a gate
    changes."""
    numbers = (
        one.until, *one.loss, one.heard, one.now, one.sender, one.epoch, one.report.owner,
        one.report.epoch, one.began, one.met.takeovers, one.met.surprises, one.met.ended, one.met.expiry_ms,
    )  # fmt: skip
    lengths = (one.bound, one.least, one.soon)
    return c.all_of(
        *[counts(c, n) for n in numbers],
        *[c.all_of(n >= 0, n <= 2**56) for n in lengths],
        c.define(counting.take_turns, one.report, one.made),
    )


def after_event(c: Claim, one: Counted, e: Event) -> Counted:
    """The state after an event. Once a number is out of counting range nothing more is claimed; impossible events
    have no effect: a report of an epoch that has not begun, and an open intruder while none is open."""
    gate, cycle, end, suspended, tally = one

    def small(number: Any) -> Any:
        return c.when(counts(c, number), number, 0)

    numbers = (gate.owner, gate.epoch, cycle.mode, cycle.relapses, cycle.handed_ms, cycle.free_ms)
    fine = c.all_of(tally.counted, *[counts(c, n) for n in (*numbers, end.epoch)])
    gate = Gate(small(gate.owner), small(gate.epoch), gate.offered)
    cycle = Cycle(
        small(cycle.mode), small(cycle.relapses), cycle.handed, small(cycle.handed_ms),
        cycle.free, small(cycle.free_ms),
    )  # fmt: skip
    end = LinkEnd(end.active, small(end.epoch), end.alive)
    # an intruder
    there = c.implies(c.define(counting.is_open, e.met), tally.open >= 1)
    looks, resumes = (c.all_of(e.kind == kind, there) for kind in (LOOK, RESUME))
    seen = c.use(encounter_looked, e.met, e.allowed, e.now)
    resumed = c.use(encounter_resumed, e.met, e.allowed, e.until)
    # a heartbeat
    beats = e.kind == BEAT
    noticed = c.use(cycle_begun, cycle, c.use(gate_accepts, gate, 1, gate.epoch), e.now)
    watches = noticed.mode == instance.MONITOR
    named = c.use(encounter_watched, e.met, e.foreseen)
    takes = c.use(loss_takes, e.loss, c.any_of(named.acts, e.zone))
    cycled = c.use(cycle_watched, noticed, takes, e.now, e.soon)
    flown = c.use(cycle_flown, noticed, e.free, e.heard, e.now, e.bound, e.least)
    does = c.when(watches, cycled, flown)
    wished = c.use(gate_wished, gate, does.act)
    taken = c.all_of(beats, does.act == instance.TAKE_OVER)
    withdrawn = c.all_of(beats, does.act == instance.WITHDRAW)
    because = c.all_of(taken, named.acts)
    met = c.when(looks, seen, c.when(resumes, resumed, c.when(because, named.encounter, e.met)))
    # a command, and a line
    stands = c.use(gate_after, gate, e.sender, e.epoch)
    lines = c.all_of(e.kind == LINE, e.report.epoch <= gate.epoch)
    moved = c.use(link_mode, end, e.report, e.says, e.began)
    held = c.use(suspended_after, suspended, moved.act)
    hears = c.all_of(lines, held, c.negation(suspended))
    believed = c.all_of(
        lines, c.any_of(moved.end.epoch != end.epoch, moved.end.active != end.active)
    )
    return Counted(
        c.when(beats, wished, c.when(e.kind == COMMAND, stands, gate)),
        c.when(beats, does.cycle, cycle),
        c.when(lines, moved.end, end),
        c.when(lines, held, suspended),
        _tallied(c, tally, e, met, fine, (taken, because, withdrawn, hears, believed)),
    )


def _tallied(
    c: Claim, tally: counting.Tally, e: Event, met: Encounter, fine: Any, what: tuple[Any, ...]
) -> counting.Tally:
    """The counters after an event. met: the intruder's encounter; what: a takeover, one because of the intruder, a
    withdrawal, a takeover that UxAS counts, a line that it believes."""
    taken, because, withdrawn, hears, believed = what

    def more(number: Any, *whether: Any) -> Any:
        for one in whether:
            number = c.when(one, number + 1, number)
        return number

    upsets = met.surprises - e.met.surprises + met.ended - e.met.ended
    open_now = c.when(c.define(counting.is_open, met), 1, 0)
    open_was = c.when(c.define(counting.is_open, e.met), 1, 0)
    item = e.kind == ITEM
    new = counting.Tally(
        fine,
        more(tally.heard, hears),
        tally.upsets + upsets,
        more(tally.others, c.all_of(taken, c.negation(because))),
        more(tally.withdrawn, withdrawn),
        tally.before,
        tally.open + open_now - open_was,
        tally.open_then,
        more(tally.made, taken, withdrawn),
        tally.made_then,
        c.when(believed, e.made, tally.known),
    )
    begun = new._replace(
        heard=0, upsets=0, others=0, withdrawn=0, before=new.made - new.known, open_then=new.open,
        made_then=new.made,
    )  # fmt: skip
    tallied: counting.Tally = c.when(item, begun, new)
    return tallied
