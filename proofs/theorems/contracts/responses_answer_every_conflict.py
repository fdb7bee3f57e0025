"""Every conflict is answered: by the manoeuvre that is flown if it is still free of conflict and of
zones, else by one that is, and by a refusal only if there is none; one that is not ours by leaving it.
Off the mission without a conflict the vehicle keeps to the same, unless it is sent back."""

from cratous.core.contracts.responses import manoeuvre_act, response_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.responding import any_response
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    before, told = any_response(c)
    conflict, ours, good, found = told.conflict, told.ours, told.good, told.found
    step = c.use(response_step, before, *told)
    act = step.act
    answer = c.define(responses.answered, ours, before.off, good, found, act)
    c.show(c.implies(conflict, answer), "every conflict is answered")
    other = c.integer("other")
    wrong = c.define(responses.answered, ours, before.off, good, found, other)
    c.show(c.implies(c.all_of(conflict, other != act), c.negation(wrong)), "by nothing else")
    on_hold = c.same(step.response.state, responses.HOLD)
    c.show(c.implies(on_hold, c.define(responses.held, good, found, act)), "and so is a hold")
    wrong = c.define(responses.held, good, found, other)
    c.show(c.implies(c.all_of(on_hold, other != act), c.negation(wrong)), "by nothing else either")
    c.show(
        c.same(c.use(manoeuvre_act, good, found), c.when(good, 2, c.when(found, 1, 3))),
        "what is flown comes before what is found, and a refusal last",
    )
    diverts = c.same(act, responses.DIVERT)
    c.show(c.implies(diverts, found), "only a manoeuvre that was found is commanded")
    c.show(
        c.implies(
            c.same(act, responses.REFUSE), c.negation(c.any_of(found, c.all_of(good, before.off)))
        ),
        "refused is only what cannot be done",
    )
    on_mission = c.all_of(c.negation(conflict), c.negation(before.off))
    c.show(
        c.implies(on_mission, c.same(act, responses.NOTHING)),
        "a vehicle on its mission, without a conflict, is left alone",
    )
