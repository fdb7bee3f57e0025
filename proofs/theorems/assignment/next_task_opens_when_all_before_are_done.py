"""A task opens for the kernel exactly when each task that it needs is done; what is done more opens no
less, so a derivative that allows a task goes on allowing it until it is done."""

from cratous.core.assignment.steps import opened
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    done, need, more = c.mask("done"), c.mask("need"), c.mask("more")
    open_now = c.use(opened, done, need)
    each = [c.define(assignment.all_needed_done, k, done, need) for k in range(64)]
    c.show(c.same(open_now, c.all_of(*each)), "each is done")
    later = c.use(opened, done | more, need)
    c.show(c.implies(open_now, later), "it stays open")
    # one operand after the other: the tail opens when the head is done, whatever else is
    head, tail = c.mask("head"), c.mask("tail")
    both = c.use(opened, done, head | tail)
    parts = c.all_of(c.use(opened, done, head), c.use(opened, done, tail))
    c.show(c.same(both, parts), "an operand is done when its parts are")
