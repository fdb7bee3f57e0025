"""Well clear by taumod is locally convex: if it is lost at two instants of straight flight, it is lost
at every instant between them, in any frame."""

from cratous.core.well_clear import violation_interval_taumod
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    early, middle, late = c.reals("early middle late")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.premise(early <= middle)
    c.premise(middle <= late)
    c.opaque(violation_interval_taumod, well_clear.violation_taumod_at)
    limits = {"dthr": dthr, "zthr": zthr, "tthr": tthr, "tcoa": tcoa, "vmod": vmod}
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": early, "end": late}
    c.use(violation_interval_taumod, s, v, sz, vz, *limits.values(), early, late)
    lost = []
    for t in (early, middle, late):
        c.lemma("well_clear_interval_taumod_is_exact", t=t, **state, **limits)
        arguments = (s, v, sz, vz, *limits.values(), t)
        lost.append(c.define(well_clear.violation_taumod_at, *arguments))
    c.show(c.implies(c.all_of(lost[0], lost[2]), lost[1]))
