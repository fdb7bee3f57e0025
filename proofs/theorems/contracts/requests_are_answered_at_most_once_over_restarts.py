"""Whatever happens to the service of automation requests in any number of events, be it started anew at any of them and
forget its line: each request is taken, published and answered at most once and in this order, and one that was taken in
the present life is answered exactly as the line of this life says, so once. What comes for a request of a former life is
taken for no answer, as long as no number of a request is given again."""

from typing import Any

from cratous.core.contracts.requests import Line
from cratous.proofs.claim import Claim
from cratous.proofs.methods.restarts import (
    MANY,
    Asked,
    Served,
    after_event,
    any_event,
    any_served,
    each_event,
    stage_by,
)
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.contracts import requests


def claim(c: Claim) -> None:
    asked, limit = Asked(c.integer("its_life"), c.integer("its_ticket")), c.integer("limit")
    c.premise(c.all_of(asked.life >= 0, asked.ticket >= 0, limit >= 0, limit <= 2**60))
    event = any_event(c)

    def so(state: list[Any]) -> Any:
        one = state[0]
        present = c.same(one.stage, stage_by(c, one.line, asked.ticket))
        lived = c.all_of(one.stage >= requests.NEW, one.stage <= requests.ANSWERED)
        to_come = c.implies(asked.life > one.life, one.stage == requests.NEW)
        said = c.all_of(lived, to_come, c.implies(asked.life == one.life, present))
        return c.implies(one.counted, said)

    def invariant(state: list[Any]) -> Any:
        line = state[0].line
        counters = c.all_of(line.answered >= 0, line.answered <= line.taken, line.taken <= MANY)
        planned = c.implies(line.busy, line.answered < line.taken)
        kept = c.all_of(counters, planned, state[0].life >= 0)
        return c.all_of(c.implies(state[0].counted, kept), so(state))

    def after(state: list[Any]) -> Any:
        return after_event(c, state[0], event, asked, limit)

    along_items(
        c,
        [],
        item=Items((), each_event(c, event), (event,)),
        invariant=invariant,
        goal=so,
        text="answered once",
        beside=[Beside(Served(True, 0, Line(0, 0, False, 0), 0), any_served(c), after)],
    )
