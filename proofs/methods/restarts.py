"""A line of requests whose service may fail at a step or be started anew, with an eye on one request."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.contracts.requests import Line, happening, line_step, stage_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.vehicles import counts
from cratous.spec.contracts import requests

MANY = 2**60
"""So many requests a line takes."""
ANEW = 0
"""The event in which the service is started anew; the others are those of `line_step`."""


class Served(NamedTuple):
    """counted: no number has grown too large to be counted on; line: as the service has it, and as it is kept beside
    it; stage: of the one request, as whoever sent it sees it; answers: so many it has got."""

    counted: Any
    line: Line
    kept: Line
    stage: Any
    answers: Any


class Event(NamedTuple):
    """kind, ticket, now_ms, limit_ms: as of `line_step`; fails: the service breaks off before its step is done."""

    kind: Any
    ticket: Any
    now_ms: Any
    limit_ms: Any
    fails: Any


def any_served(c: Claim) -> Served:
    """Any, its numbers of any size."""

    def line(name: str) -> Line:
        taken, answered = c.whole(f"{name}_taken"), c.whole(f"{name}_answered")
        return Line(taken, answered, c.boolean(f"{name}_busy"), c.whole(f"{name}_sent_ms"))

    return Served(
        c.boolean("counted"), line("line"), line("kept"), c.whole("stage"), c.whole("answers")
    )


def any_event(c: Claim) -> Event:
    """Anything that may happen; a service that is started anew may have another limit."""
    kind, ticket, now_ms, limit_ms = (
        c.whole(name) for name in ("kind", "of_ticket", "now_ms", "limit_ms")
    )
    return Event(kind, ticket, now_ms, limit_ms, c.boolean("fails"))


def each_event(c: Claim, one: Event) -> Any:
    """What is given of each: numbers that a machine counts."""
    return c.all_of(*[counts(c, number) for number in one[:4]])


def stage_by(c: Claim, line: Line, ticket: Any) -> Any:
    """Where the counters of a line say that its request is."""
    turn = c.when(c.all_of(line.busy, ticket == line.answered), requests.PUBLISHED, requests.TAKEN)
    begun = c.when(ticket < line.answered, requests.ANSWERED, turn)
    return c.when(ticket >= line.taken, requests.NEW, begun)


def after_event(c: Claim, one: Served, event: Event, ticket: Any) -> Served:
    """Afterwards. What fails is not done and nothing of it is sent; whoever is started anew goes on with what is kept."""

    def small(number: Any) -> Any:
        return c.when(counts(c, number), number, 0)

    def counted(line: Line) -> Line:
        return Line(small(line.taken), small(line.answered), line.busy, small(line.sent_ms))

    numbers = (*one.line[:2], one.line.sent_ms, *one.kept[:2], one.kept.sent_ms, one.stage)
    fine = c.all_of(one.counted, *[counts(c, number) for number in (*numbers, one.answers)])
    line, kept, stage = counted(one.line), counted(one.kept), small(one.stage)
    step = c.use(line_step, line, event.kind, event.ticket, event.now_ms, event.limit_ms)
    what = c.use(happening, step.act, step.ticket, ticket)
    moved = c.use(stage_after, stage, what)
    anew, fails = event.kind == ANEW, event.fails
    idle = c.any_of(anew, fails)
    new = [
        c.when(anew, was, c.when(fails, old, after))
        for was, old, after in zip(kept, line, step.line, strict=True)
    ]
    still = [c.when(idle, was, after) for was, after in zip(kept, step.line, strict=True)]
    answered = c.when(what == requests.ANSWERED, small(one.answers) + 1, small(one.answers))
    answers = c.when(idle, small(one.answers), answered)
    return Served(fine, Line(*new), Line(*still), c.when(idle, stage, moved), answers)
