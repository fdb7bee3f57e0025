"""More urgent is what its definition says, and an order: nobody is more urgent than itself, of two at most
one is more urgent than the other, and who is more urgent than a more urgent one is so too. So the most
urgent intruder does not depend on the order in which they are looked at, but for exact ties."""

from cratous.core.daa.coordination import more_urgent
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    a, b, e = (c.reals(f"size_{n} time_{n}") for n in ("a", "b", "c"))
    found = c.use(more_urgent, *a, *b)
    c.show(c.same(found, c.define(daa_coordination.more_urgent, *a, *b)), "definition")
    c.show(c.negation(c.use(more_urgent, *a, *a)), "not than itself")
    c.show(c.implies(found, c.negation(c.use(more_urgent, *b, *a))), "one of two")
    then = c.all_of(found, c.use(more_urgent, *b, *e))
    c.show(c.implies(then, c.use(more_urgent, *a, *e)), "transitive")
    ties = c.all_of(c.negation(found), c.negation(c.use(more_urgent, *b, *a)))
    c.show(c.implies(ties, c.same(tuple(a), tuple(b))), "ties are exact")
