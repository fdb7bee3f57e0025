"""An operand fits exactly if no task of the whole term was begun that does not stand in the operand; for
64 tasks."""

from cratous.core.algebra.steps import operand_fits
from cratous.proofs.claim import Claim
from cratous.spec.algebra import operators


def claim(c: Claim) -> None:
    whole, part, begun = c.mask("whole"), c.mask("part"), c.mask("begun")
    fits = c.use(operand_fits, whole, part, begun)
    each = [c.define(operators.none_beside, k, whole, part, begun) for k in range(64)]
    c.show(c.same(fits, c.all_of(*each)), "if and only if it is so of each task")
