"""Whatever happens to the service of automation requests in any number of events, be it started anew or fail at any of them,
and with another limit each time: each request is taken, published and answered in this order and never twice, it has
got one response exactly when the line has it answered, else none, and no service that is started anew has another line than
the one before it."""

from typing import Any

from cratous.core.contracts.requests import Line
from cratous.proofs.claim import Claim
from cratous.proofs.methods.restarts import (
    MANY,
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
    ticket = c.integer("ticket")
    c.premise(c.all_of(ticket >= 0, ticket <= MANY))
    event = any_event(c)

    def once(state: list[Any]) -> Any:
        one = state[0]
        stage = c.same(one.stage, stage_by(c, one.line, ticket))
        lived = c.all_of(one.stage >= requests.NEW, one.stage <= requests.ANSWERED)
        got = c.when(one.stage == requests.ANSWERED, 1, 0)
        said = c.all_of(stage, lived, one.answers == got, c.same(one.line, one.kept))
        return c.implies(one.counted, said)

    def invariant(state: list[Any]) -> Any:
        line = state[0].line
        counters = c.all_of(line.answered >= 0, line.answered <= line.taken, line.taken <= MANY)
        planned = c.implies(line.busy, line.answered < line.taken)
        return c.all_of(c.implies(state[0].counted, c.all_of(counters, planned)), once(state))

    def after(state: list[Any]) -> Any:
        return after_event(c, state[0], event, ticket)

    first = Line(0, 0, False, 0)
    along_items(
        c,
        [],
        item=Items((), each_event(c, event), (event,)),
        invariant=invariant,
        goal=once,
        text="answered once",
        beside=[Beside(Served(True, first, first, requests.NEW, 0), any_served(c), after)],
    )
