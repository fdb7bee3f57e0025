"""There is no way out exactly if some manoeuvre was tried and every one, of any number, was refused; one
free manoeuvre is a way out; anything else is undecided."""

from cratous.core.excuse.way_out import answer_result, way_out
from cratous.proofs.claim import Claim
from cratous.spec import excuse


def claim(c: Claim) -> None:
    free, open_, some = c.boolean("free"), c.boolean("open"), c.boolean("some")

    other = c.integer("other")
    answered = c.any_of(other == 1, other == -1)
    c.show(c.implies(c.negation(answered), c.use(answer_result, other) == 0), "nothing else counts")
    tried = c.define(excuse.tried_step, excuse.Tried(free, open_, some), 1)
    c.show(c.same(tried.open, open_), "a free one leaves open what is open")

    def related(found: object, tried: excuse.Tried) -> object:
        word = c.when(tried.free, 1, c.when(tried.open, 0, c.when(tried.some, -1, 2)))
        return c.all_of(
            c.same(found, word), c.implies(c.any_of(tried.free, tried.open), tried.some)
        )

    c.fold(
        way_out,
        acc=c.whole("so_far"),
        model=excuse.Tried(free, open_, some),
        item=(c.integer("manoeuvre"),),
        context=(),
        model_start=excuse.Tried(False, False, False),
        model_step=excuse.tried_step,
        model_finish=excuse.answer,
        relation=related,
    )
