"""For every sequence of arrivals, answers (right, late, foreign or repeated) and instants, of whatever
length: each automation request is taken, published and answered once and in this order, requests
are published first come first served, and at most one is being planned at a time."""

from typing import Any

from cratous.core.contracts.requests import Watched, requests_in_order
from cratous.proofs.claim import Claim
from cratous.spec.contracts.requests import Pair, in_order

MANY = 2**60


def stage_of(c: Claim, w: Any, ticket: Any) -> Any:
    """Where the counters say that a ticket's request is."""
    turn = c.when(c.all_of(w.busy, ticket == w.answered), 2, 1)
    return c.when(ticket >= w.taken, 0, c.when(ticket < w.answered, 3, turn))


def claim(c: Claim) -> None:
    event, ticket, now, limit = (c.integer(n) for n in ("event", "ticket", "now_ms", "limit_ms"))
    one, other = c.integer("one"), c.integer("other")
    c.premise(one >= 0)
    c.premise(one < other)
    w = Watched(
        c.whole("taken"),
        c.whole("answered"),
        c.boolean("busy"),
        c.whole("sent_ms"),
        c.whole("first"),
        c.whole("second"),
        c.boolean("held"),
    )

    def related(w: Any, held: Any) -> Any:
        counters = c.all_of(w.answered >= 0, w.answered <= w.taken, w.taken <= MANY)
        planned = c.implies(w.busy, w.answered < w.taken)
        instant = c.all_of(w.sent_ms >= -(2**61), w.sent_ms <= 2**61)
        unsent = c.implies(w.taken == 0, w.sent_ms == 0)
        stages = c.all_of(
            c.same(w.first, stage_of(c, w, one)), c.same(w.second, stage_of(c, w, other))
        )
        orderly = c.define(in_order, Pair(w.first, w.second))
        return c.all_of(
            counters, planned, instant, unsent, stages, orderly, c.same(w.held, held), w.held
        )

    c.fold(
        requests_in_order,
        acc=w,
        model=c.boolean("all_held"),
        item=(event, ticket, now),
        context=(limit, one, other),
        model_start=True,
        model_step=lambda held, *_: held,
        relation=related,
    )
