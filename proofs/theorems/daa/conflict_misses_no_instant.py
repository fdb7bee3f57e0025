"""If a volume of any kind is violated at some instant of [B, T] of straight flight, then the kernel
that alerting and bands ask says so."""

from cratous.core.daa.volume import in_conflict
from cratous.core.well_clear import (
    violation_during_taumod,
    violation_during_tcpa,
    violation_during_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_instants, any_state, any_thresholds, by_name
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    s, v, sz, vz = any_state(c)
    limits = any_thresholds(c)
    begin, t, end = any_instants(c, "begin t end")
    c.opaque(
        violation_during_taumod,
        violation_during_tcpa,
        violation_during_tep,
        well_clear.violation_taumod_at,
        well_clear.violation_tcpa_at,
        well_clear.violation_tep_at,
    )
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end, "t": t}
    size = by_name(limits)
    for name in ("taumod", "tcpa", "tep"):
        c.lemma(f"well_clear_detection_{name}_misses_no_instant", **state, **size)
    found = c.use(in_conflict, kind, s, v, sz, vz, limits, begin, end)
    lost = c.define(daa_meaning.violated_at, kind, s, v, sz, vz, limits, t)
    c.show(c.implies(lost, found))
