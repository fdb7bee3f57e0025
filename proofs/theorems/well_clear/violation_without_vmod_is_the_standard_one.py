"""With VMOD switched off the combined kernel for tau_mod is the one by TCOA alone, the standard's."""

from cratous.core.well_clear import violation, violation_taumod
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_by_tcoa


def claim(c: Claim) -> None:
    (s, v, sz, vz), (dthr, zthr, tthr, tcoa) = any_by_tcoa(c)
    standard = c.use(violation, s, v, sz, vz, dthr, zthr, tthr, tcoa)
    c.show(
        c.same(
            c.use(violation_taumod, s, v, sz, vz, Thresholds(dthr, zthr, tthr, tcoa, 0)), standard
        )
    )
