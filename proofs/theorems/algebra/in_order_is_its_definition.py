"""An operand has waited for the one before it exactly if at every instant at which something of it has begun
the operator lets it begin: `.` when the one before is done whole and has ended, `~` when some of it
has begun."""

from cratous.core.algebra.steps import Ran, in_order
from cratous.proofs.claim import Claim
from cratous.spec.algebra import operators


def claim(c: Claim) -> None:
    op, whole, t = c.integer("op"), c.boolean("whole"), c.integer("t")
    before = Ran(c.boolean("before.some"), c.integer("before.start"), c.integer("before.end"))
    later = Ran(c.boolean("later.some"), c.integer("later.start"), c.integer("later.end"))
    waited = c.use(in_order, op, whole, before, later)
    at_t = c.define(operators.lets_begin, t, op, whole, before, later)
    c.show(c.implies(waited, at_t), "if it has, it was let begin at every instant")
    # the operand's own start is the instant that shows it
    at_start = c.define(operators.lets_begin, later.start, op, whole, before, later)
    c.show(c.implies(at_start, waited), "if not, its start shows it")
