"""After a conflict a vehicle comes back: as soon as the way back is free and has been for long enough the
mission is commanded, again if it has no effect, and once the vehicle says that it flies its mission
the response is over; nothing but a conflict or a way that is not free comes between."""

from cratous.core.contracts.responses import Response, response_step
from cratous.proofs.claim import Claim
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    before = Response(c.integer("state"), c.boolean("off"))
    ours, good, found, taken = (c.boolean(n) for n in ("ours", "good", "found", "taken"))
    free, lasted = c.boolean("free"), c.boolean("lasted")
    c.premise(c.define(responses.consistent, before.state, before.off))
    step = c.use(response_step, before, False, ours, good, found, free, lasted, taken)
    state, act = step.response.state, step.act
    is_back = c.define(responses.back, before.state, False, taken)
    due = c.all_of(before.off, free, lasted, c.negation(is_back))
    sent = c.all_of(c.same(act, responses.SEND_BACK), c.same(state, responses.RESUME))
    c.show(c.implies(due, sent), "a vehicle whose way back is free is sent back")
    over = c.all_of(c.same(state, responses.MISSION), c.negation(step.response.off))
    c.show(c.implies(is_back, over), "who says that it is back is on its mission")
    waits = c.all_of(
        c.same(before.state, responses.RESUME), free, c.negation(lasted), c.negation(taken)
    )
    stays = c.all_of(c.same(state, responses.RESUME), c.same(act, responses.NOTHING))
    c.show(c.implies(waits, stays), "until then it waits for the vehicle")
    c.show(c.implies(c.negation(before.off), over), "who was never off it is on it at once")
