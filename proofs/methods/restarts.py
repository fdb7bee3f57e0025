"""A queue of requests whose service may fail in a step or be restarted, with one request tracked."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.contracts.requests import Line, happening, line_step, stage_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.vehicles import counts
from cratous.spec.contracts import requests

MANY = 2**60
"""The most requests that a queue takes."""
ANEW = 0
"""The event of a restart of the service; the others are those of `line_step`."""


class Served(NamedTuple):
    """counted: no number is out of counting range; line: the queue in the service; kept: as stored beside it; stage:
    of the tracked request, as its sender sees it; answers: the number of answers it has received."""

    counted: Any
    line: Line
    kept: Line
    stage: Any
    answers: Any


class Event(NamedTuple):
    """kind, ticket, now_ms, limit_ms: as in `line_step`; fails: the service fails before its step is complete."""

    kind: Any
    ticket: Any
    now_ms: Any
    limit_ms: Any
    fails: Any


def any_served(c: Claim) -> Served:
    """An arbitrary state, with numbers of any size."""

    def line(name: str) -> Line:
        taken, answered = c.whole(f"{name}_taken"), c.whole(f"{name}_answered")
        return Line(taken, answered, c.boolean(f"{name}_busy"), c.whole(f"{name}_sent_ms"))

    return Served(
        c.boolean("counted"), line("line"), line("kept"), c.whole("stage"), c.whole("answers")
    )


def any_event(c: Claim) -> Event:
    """An arbitrary event; a restarted service may have another limit."""
    kind, ticket, now_ms, limit_ms = (
        c.whole(name) for name in ("kind", "of_ticket", "now_ms", "limit_ms")
    )
    return Event(kind, ticket, now_ms, limit_ms, c.boolean("fails"))


def each_event(c: Claim, one: Event) -> Any:
    """Condition on every event: numbers are within counting range."""
    return c.all_of(*[counts(c, number) for number in one[:4]])


def stage_by(c: Claim, line: Line, ticket: Any) -> Any:
    """The stage of a request according to the counters of a queue."""
    turn = c.when(c.all_of(line.busy, ticket == line.answered), requests.PUBLISHED, requests.TAKEN)
    begun = c.when(ticket < line.answered, requests.ANSWERED, turn)
    return c.when(ticket >= line.taken, requests.NEW, begun)


def after_event(c: Claim, one: Served, event: Event, ticket: Any) -> Served:
    """The state after an event. A failed step has no effect and sends nothing; a restarted service continues from the
    stored queue."""

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
