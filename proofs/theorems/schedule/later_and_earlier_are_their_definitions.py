"""The later of two times is the least that neither of them exceeds, the earlier the greatest that
exceeds neither."""

from cratous.core.schedule.rows import earlier, later
from cratous.proofs.claim import Claim
from cratous.spec import schedule


def claim(c: Claim) -> None:
    a, b, t = c.integer("a"), c.integer("b"), c.integer("t")
    last, first = c.use(later, a, b), c.use(earlier, a, b)
    c.show(c.same(t <= last, c.define(schedule.later_of, t, a, b)), "later")
    c.show(c.same(t >= first, c.define(schedule.earlier_of, t, a, b)), "earlier")
