"""Watching two tickets changes nothing: the line goes on exactly as it does unwatched, and the stage of
either ticket moves by what the line did, and by nothing else. All is held to be in order exactly as long
as it is by definition."""

from cratous.core.contracts.requests import (
    Line,
    Watched,
    happening,
    line_step,
    stage_after,
    watched_step,
)
from cratous.proofs.claim import Claim
from cratous.spec.contracts.requests import Pair, in_order


def claim(c: Claim) -> None:
    event, ticket, now, limit = (c.integer(n) for n in ("event", "ticket", "now_ms", "limit_ms"))
    one, other, first, second = (c.integer(n) for n in ("one", "other", "first", "second"))
    served = Line(
        c.integer("taken"), c.integer("answered"), c.boolean("busy"), c.integer("sent_ms")
    )
    c.opaque(line_step, happening, stage_after)
    held = c.boolean("held")
    watched = Watched(*served, first, second, held)
    w = c.use(watched_step, watched, event, ticket, now, limit, one, other)
    line, act, about = c.use(line_step, served, event, ticket, now, limit)
    c.show(c.same(Line(w.taken, w.answered, w.busy, w.sent_ms), line), "the line")
    for seen, before, watched_one in ((w.first, first, one), (w.second, second, other)):
        moved = c.use(stage_after, before, c.use(happening, act, about, watched_one))
        c.show(seen == moved, "a ticket")
    orderly = c.define(in_order, Pair(w.first, w.second))
    c.show(c.implies(w.second >= 0, c.same(w.held, c.all_of(held, orderly))), "in order")
    c.show(c.negation(c.define(in_order, Pair(1, -1))), "a stage that there is not")
