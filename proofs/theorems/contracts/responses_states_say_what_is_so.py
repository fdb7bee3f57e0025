"""The state of a response is what its words say: in conflict while a conflict is ours, right of way
while it is others', on hold or resume while off the mission without one, on mission else; and each
step keeps it consistent with whether the vehicle is off its mission."""

from cratous.core.contracts.responses import response_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.responding import any_response
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    before, told = any_response(c)
    conflict, ours, taken = told.conflict, told.ours, told.taken
    step = c.use(response_step, before, *told)
    state, off = step.response
    c.show(c.define(responses.consistent, 0, False), "at the start")
    c.show(c.define(responses.consistent, state, off), "consistent after every step")
    c.show(c.define(responses.says_what_is_so, state, off, conflict, ours), "the words are true")
    left = c.same(step.act, responses.DIVERT)
    is_back = c.define(responses.back, before.state, conflict, taken)
    c.show(
        c.same(off, c.all_of(c.any_of(before.off, left), c.negation(is_back))),
        "off the mission from a manoeuvre on until the vehicle says that it is back",
    )
