"""A task is held to its window exactly if it ran at some instant and at none outside of the window, or did
not run and need not."""

from cratous.core.algebra.steps import Ran, Window, task_held
from cratous.proofs.claim import Claim
from cratous.spec.algebra import operators


def claim(c: Claim) -> None:
    needed, t, u = c.boolean("needed"), c.integer("t"), c.integer("u")
    ran = Ran(c.boolean("some"), c.integer("start"), c.integer("end"))
    window = Window(c.whole("first"), c.whole("last"))
    c.premise(c.all_of(window.first >= -(2**62), window.first <= 2**62))
    c.premise(c.all_of(window.last >= -(2**62), window.last <= 2**62))
    held = c.use(task_held, needed, ran, window)
    witness = c.define(operators.task_is_held, ran.start, u, needed, ran, window)
    c.show(c.implies(held, witness), "if it is, it runs at its start and never outside")
    at_start = c.define(operators.task_is_held, t, ran.start, needed, ran, window)
    at_end = c.define(operators.task_is_held, t, ran.end, needed, ran, window)
    c.show(c.implies(c.all_of(at_start, at_end), held), "if not, its start or end shows it")
