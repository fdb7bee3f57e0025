"""A task stands in two terms together exactly if it stands in one of them, whatever its number from 0 to 63."""

from cratous.core.algebra.steps import tasks_with
from cratous.proofs.claim import Claim
from cratous.spec.algebra import operators


def claim(c: Claim) -> None:
    one, other = c.mask("one"), c.mask("other")
    both = c.use(tasks_with, one, other)
    for k in range(64):
        stands = c.define(operators.stands_in, k, both)
        wanted = c.define(operators.stands_in_one_of, k, one, other)
        c.show(c.same(stands, wanted), f"task number {k}")
