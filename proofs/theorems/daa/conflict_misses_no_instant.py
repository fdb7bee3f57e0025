"""If a volume of any kind is violated at some instant of [B, T] of straight flight, then the kernel
that alerting and bands ask says so."""

from cratous.core.daa.volume import in_conflict
from cratous.core.well_clear import (
    violation_during_taumod,
    violation_during_tcpa,
    violation_during_tep,
)
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod = c.reals("sz vz dthr zthr tthr tcoa vmod")
    begin, end, t = c.reals("begin end t")
    for threshold in (dthr, zthr, tthr, tcoa, vmod):
        c.premise(threshold >= 0)
    c.premise(begin <= t)
    c.premise(t <= end)
    c.opaque(
        violation_during_taumod,
        violation_during_tcpa,
        violation_during_tep,
        well_clear.violation_taumod_at,
        well_clear.violation_tcpa_at,
        well_clear.violation_tep_at,
    )
    limits = (dthr, zthr, tthr, tcoa, vmod)
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end, "t": t}
    size = {"dthr": dthr, "zthr": zthr, "tthr": tthr, "tcoa": tcoa, "vmod": vmod}
    for name in ("taumod", "tcpa", "tep"):
        c.lemma(f"well_clear_detection_{name}_misses_no_instant", **state, **size)
    found = c.use(in_conflict, kind, s, v, sz, vz, *limits, begin, end)
    lost = c.define(daa_meaning.violated_at, kind, s, v, sz, vz, *limits, t)
    c.show(c.implies(lost, found))
