"""A vehicle that is off its mission is sent back to it exactly when there is no conflict and the way is
free and has been for long enough, unless it says that it is back; and once the way is not
free any more, a vehicle that was sent back is held again at once."""

from cratous.core.contracts.responses import response_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.responding import any_response
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    before, told = any_response(c)
    conflict, free, lasted, taken = told.conflict, told.free, told.lasted, told.taken
    step = c.use(response_step, before, *told)
    sent = c.same(step.act, responses.SEND_BACK)
    may = c.define(responses.may_be_sent_back, conflict, free, lasted)
    c.show(
        c.implies(sent, c.all_of(may, before.off)), "only when it may be, and is off its mission"
    )
    is_back = c.define(responses.back, before.state, conflict, taken)
    c.show(
        c.implies(c.all_of(may, before.off, c.negation(is_back)), sent),
        "and whenever it may be, unless the vehicle is back",
    )
    resumes = c.same(step.response.state, responses.RESUME)
    c.show(c.implies(resumes, c.all_of(free, c.negation(conflict))), "only on a free way")
    was = c.same(before.state, responses.RESUME)
    lost = c.all_of(was, c.negation(c.any_of(conflict, free, taken)))
    c.show(
        c.implies(lost, c.same(step.response.state, responses.HOLD)),
        "an offer that is not free any more is withdrawn",
    )
    c.show(c.implies(resumes, c.any_of(sent, was)), "resume is only ever begun by the command")
