"""At every instant some task of two terms together has begun exactly if one has of either, and all that ran
of them has ended exactly if it has of both; so for any number of terms, one after the other. Nothing
changes with a term of which nothing ran."""

from cratous.core.algebra.steps import Ran, ran_with
from cratous.proofs.claim import Claim
from cratous.spec.algebra import operators


def claim(c: Claim) -> None:
    one = Ran(c.boolean("one.some"), c.integer("one.start"), c.integer("one.end"))
    other = Ran(c.boolean("other.some"), c.integer("other.start"), c.integer("other.end"))
    t = c.integer("t")
    both = c.use(ran_with, one, other)
    wanted = c.define(operators.seen_together, t, one, other)
    c.show(c.same(c.define(operators.seen, t, both), wanted), "at every instant")
    nothing = Ran(False, 0, 0)
    for none, text in (
        (c.use(ran_with, nothing, one), "before"),
        (c.use(ran_with, one, nothing), "after"),
    ):
        now = c.define(operators.seen, t, none)
        c.show(c.same(now, c.define(operators.seen, t, one)), f"nothing {text} it")
