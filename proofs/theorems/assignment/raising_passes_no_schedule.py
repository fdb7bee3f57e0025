"""Raising a start to what a row demands, or to a time before or after another start, never passes a
schedule that satisfies it, and nothing rises exactly where it holds; a start that breaks an upper bound
breaks it in every schedule above. One raise; times at which nothing rises any more are made of these."""

from cratous.core.assignment.steps import raised
from cratous.core.schedule.rows import row_holds
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    x, x_ref = c.integer("x"), c.integer("x_ref")
    start, ref, lo = c.integer("start"), c.integer("ref"), c.integer("lo")
    end, hi, kind = c.integer("end"), c.integer("hi"), c.integer("kind")
    for time in (x, x_ref, start, ref, end, hi):
        c.premise(c.all_of(time >= 0, time <= 2**59))
    # a start may have to be so long after another one, or no longer than that before it
    c.premise(c.all_of(lo >= -(2**59), lo <= 2**59))
    higher = c.use(raised, start, ref, lo)
    demand = c.define(assignment.row_is_raised, x, start, ref, lo)
    c.show(c.same(demand, x >= higher), "it is the least that keeps to both")
    # x is any schedule that satisfies the row, and lies above the bounds so far
    c.premise(c.any_of(kind == 1, kind == 2))
    satisfied = c.use(row_holds, kind, x, x, x_ref, lo, hi)
    c.show(
        c.implies(c.all_of(x >= start, x_ref >= ref, satisfied), x >= higher),
        "no schedule that satisfies the row is passed",
    )
    at_rest = c.use(row_holds, kind, start, end, ref, lo, hi)
    c.show(c.same(higher == start, at_rest), "nothing rises exactly where the row holds")
    # an upper bound that the least times break is broken by every schedule above them
    c.premise(x_ref == ref)
    above = c.use(row_holds, 6, x, x, 0, 0, hi)
    least = c.use(row_holds, 6, higher, higher, 0, 0, hi)
    c.show(c.implies(c.all_of(x >= higher, above), least), "what is too late stays too late")
