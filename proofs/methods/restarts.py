"""A line of requests whose service may be started anew and then forgets it, with an eye on one request of one of its lives."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.contracts.requests import Line, happening, line_step, stage_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.vehicles import counts
from cratous.spec.contracts import requests

MANY = 2**60
"""So many requests a line takes."""
RESTART = 0
"""The event in which the service is started anew; the others are those of `line_step`."""


class Served(NamedTuple):
    """counted: no number has grown too large to be counted on; life: how often the service was started anew; line: of
    this life; stage: of the one request."""

    counted: Any
    life: Any
    line: Line
    stage: Any


class Asked(NamedTuple):
    """The one request: taken in which life of the service, and under which ticket."""

    life: Any
    ticket: Any


class Event(NamedTuple):
    """kind, ticket, now_ms: as of `line_step`; life: in which the request was published that is answered."""

    kind: Any
    life: Any
    ticket: Any
    now_ms: Any


def any_served(c: Claim) -> Served:
    """Any, its numbers of any size."""
    line = Line(c.whole("taken"), c.whole("answered"), c.boolean("busy"), c.whole("sent_ms"))
    return Served(c.boolean("counted"), c.whole("life"), line, c.whole("stage"))


def any_event(c: Claim) -> Event:
    """Anything that may happen, an answer to a request of a former life too."""
    return Event(*[c.whole(name) for name in ("kind", "of_life", "of_ticket", "now_ms")])


def each_event(c: Claim, one: Event) -> Any:
    """What is given of each: numbers that a machine counts."""
    return c.all_of(*[counts(c, number) for number in one])


def stage_by(c: Claim, line: Line, ticket: Any) -> Any:
    """Where the counters of a life say that its request is."""
    turn = c.when(c.all_of(line.busy, ticket == line.answered), requests.PUBLISHED, requests.TAKEN)
    begun = c.when(ticket < line.answered, requests.ANSWERED, turn)
    return c.when(ticket >= line.taken, requests.NEW, begun)


def after_event(c: Claim, one: Served, event: Event, asked: Asked, limit: Any) -> Served:
    """Afterwards. An answer to a request of another life is to none of this line's."""
    numbers = (one.life, *one.line[:2], one.line.sent_ms, one.stage)
    counted = c.all_of(one.counted, *[counts(c, number) for number in numbers])
    life, taken, answered, sent, stage = (c.when(counts(c, n), n, 0) for n in numbers)
    ticket = c.when(event.life == life, event.ticket, -1)
    line = Line(taken, answered, one.line.busy, sent)
    step = c.use(line_step, line, event.kind, ticket, event.now_ms, limit)
    about = c.when(asked.life == life, asked.ticket, -2)
    moved = c.use(stage_after, stage, c.use(happening, step.act, step.ticket, about))
    anew = event.kind == RESTART
    fresh = Line(0, 0, False, 0)
    after = Line(*[c.when(anew, new, old) for new, old in zip(fresh, step.line, strict=True)])
    return Served(counted, c.when(anew, life + 1, life), after, c.when(anew, stage, moved))
