"""A disc lies in another exactly when its centre is no farther from the other's than the radii differ."""

from cratous.core.permit.tubes import disc_within
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    p = c.vector("p")
    inner, outer = c.reals("inner outer")
    gap = outer - inner
    near = c.all_of(gap >= 0, c.define(well_clear.within, p, gap))
    c.show(c.same(c.use(disc_within, p, inner, outer), near))
