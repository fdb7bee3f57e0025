"""The combined kernel says that well clear is lost exactly when the horizontal and the vertical
volume of the definition are violated at once."""

from cratous.core.well_clear import violation
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_by_tcoa
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    (s, v, sz, vz), (dthr, zthr, tthr, tcoa) = any_by_tcoa(c)
    arguments = (s, v, sz, vz, dthr, zthr, tthr, tcoa)
    verdict = c.use(violation, *arguments)
    c.show(c.same(verdict, c.define(well_clear.violation, *arguments)))
