"""With VMOD switched off the combined kernel for tau_mod is the one by TCOA alone, the standard's."""

from cratous.core.well_clear import violation, violation_taumod
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa = c.reals("sz vz dthr zthr tthr tcoa")
    for threshold in (dthr, zthr, tthr, tcoa):
        c.premise(threshold >= 0)
    standard = c.use(violation, s, v, sz, vz, dthr, zthr, tthr, tcoa)
    c.show(
        c.same(
            c.use(violation_taumod, s, v, sz, vz, Thresholds(dthr, zthr, tthr, tcoa, 0)), standard
        )
    )
