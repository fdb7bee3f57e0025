"""A vehicle with the right of way does not manoeuvre: while a conflict is for others to avoid, nothing is
commanded, whatever manoeuvres there are, and it stays on its mission, or off it, as it was; unless it
is off its mission and what it flies would meet a zone, which it leaves by a manoeuvre that is free of both."""

from cratous.core.contracts.responses import Response, response_step
from cratous.proofs.claim import Claim
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    before = Response(c.integer("state"), c.boolean("off"))
    names = ("good", "found", "free", "lasted", "taken")
    good, found, free, lasted, taken = (c.boolean(name) for name in names)
    c.premise(c.define(responses.consistent, before.state, before.off))
    step = c.use(response_step, before, True, False, good, found, free, lasted, taken)
    astray = c.all_of(before.off, c.negation(good))
    c.show(
        c.implies(c.negation(astray), c.same(step.act, responses.LEAVE)), "it is left to the others"
    )
    c.show(
        c.implies(c.all_of(astray, found), c.same(step.act, responses.DIVERT)),
        "a zone ahead of a vehicle that is off its mission is avoided",
    )
    c.show(c.same(step.response.state, responses.RIGHT_OF_WAY), "and said so")
    c.show(c.same(step.response.off, before.off), "nothing changes for the mission")
