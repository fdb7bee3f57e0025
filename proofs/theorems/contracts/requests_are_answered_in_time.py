"""No request waits for ever: nothing that happens moves an unanswered request back in line, and each
time that the line is pumped at or after the deadline of the one being planned, or with none being
planned, it moves forward by one publication or answer; so a request with n unanswered ones before
it has its answer after at most 2 n + 2 such pumps, even if no service ever responds."""

from cratous.core.contracts.requests import Line, line_step
from cratous.proofs.claim import Claim
from cratous.spec.contracts import requests


def claim(c: Claim) -> None:
    line = Line(c.integer("taken"), c.integer("answered"), c.boolean("busy"), c.integer("sent_ms"))
    event, answer, now, limit = (c.integer(n) for n in ("event", "answer", "now_ms", "limit_ms"))
    ticket = c.integer("ticket")
    c.premise(c.all_of(line.answered >= 0, line.answered <= line.taken, line.taken <= 2**60))
    c.premise(c.implies(line.busy, line.answered < line.taken))
    c.premise(c.all_of(ticket >= line.answered, ticket < line.taken))
    before = c.define(requests.steps_left, ticket - line.answered, line.busy)
    step = c.use(line_step, line, event, answer, now, limit)
    after = step.line
    left = c.when(
        after.answered > ticket,
        0,
        c.define(requests.steps_left, ticket - after.answered, after.busy),
    )
    c.show(before >= 1, "an unanswered request waits for something")
    c.show(left <= before, "nothing moves it back")
    c.show(c.implies(left < before, left == before - 1), "it moves step by step")
    due = c.any_of(c.negation(line.busy), now - line.sent_ms >= limit)
    c.show(c.implies(c.all_of(event == 3, due), left == before - 1), "a pump that is due moves it")
    c.show(c.same(left == 0, after.answered > ticket), "none left is answered")
    waits = c.all_of(line.busy, event == 3, now - line.sent_ms < limit)
    c.show(c.implies(waits, c.all_of(c.same(after, line), step.act == 0)), "not before its time")
