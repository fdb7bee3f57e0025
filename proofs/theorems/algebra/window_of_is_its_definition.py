"""An instant lies in the window of an operand exactly if a task that nothing within it bounds may run then:
the innermost timing counts, a relative one from the end or the start of the operand before."""

from cratous.core.algebra.steps import Ran, Window, window_of
from cratous.proofs.claim import Claim
from cratous.spec.algebra import operators


def claim(c: Claim) -> None:
    outer = Window(c.whole("outer.first"), c.whole("outer.last"))
    c.premise(c.all_of(outer.first >= -(2**62), outer.first <= 2**62))
    c.premise(c.all_of(outer.last >= -(2**62), outer.last <= 2**62))
    bounds = Window(c.integer("bounds.first"), c.integer("bounds.last"))
    before = Ran(c.boolean("before.some"), c.integer("before.start"), c.integer("before.end"))
    op, timing, first, t = c.integer("op"), c.integer("timing"), c.boolean("first"), c.integer("t")
    c.premise(c.all_of(timing >= 0, timing <= 2))
    window = c.use(window_of, outer, op, timing, first, before, bounds)
    wanted = c.define(operators.may_run, t, outer, op, timing, first, before, bounds)
    c.show(c.same(c.define(operators.inside, t, window), wanted), "at every instant")
    c.show(c.all_of(window.first >= -(2**62), window.last <= 2**62), "what is within it may use it")
    c.show(c.all_of(window.first <= 2**62, window.last >= -(2**62)), "as its outer window")
