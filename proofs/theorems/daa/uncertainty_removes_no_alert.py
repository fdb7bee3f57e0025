"""Whatever the volume itself detects at some instant of [B, T], sensor uncertainty mitigation detects
too, whatever the uncertainties; its span holds that instant; and without uncertainties it detects
exactly what the volume does."""

from cratous.core.daa.uncertainty import (
    Uncertainty,
    circle_span,
    layer_span,
    uncertain_conflict,
    uncertain_span,
)
from cratous.core.well_clear.during import violation_during_taumod
from cratous.core.well_clear.interval import violation_interval_taumod
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss, by_name
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, sz, vz, limits = any_loss(c)
    es, ez, ev, ew, begin, end, t = c.reals("es ez ev ew begin end t")
    for error in (es, ez, ev, ew):
        c.premise(error >= 0)
    c.premise(begin <= t)
    c.premise(t <= end)
    size = by_name(limits)
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": begin, "end": end, "t": t}
    c.opaque(
        violation_during_taumod,
        violation_interval_taumod,
        circle_span,
        layer_span,
        well_clear.violation_taumod_at,
    )
    c.lemma("well_clear_detection_taumod_misses_no_instant", **state, **size)
    c.lemma("well_clear_interval_taumod_is_exact", **state, **size)
    at = (s, v, sz, vz)
    lost = c.define(well_clear.violation_taumod_at, *at, limits, t)
    found = c.use(uncertain_conflict, *at, Uncertainty(es, ez, ev, ew), limits, begin, end)
    c.show(c.implies(lost, found), "detects")
    span = c.use(uncertain_span, *at, Uncertainty(es, ez, ev, ew), limits, begin, end)
    c.show(c.implies(lost, c.define(well_clear.in_span, *span, t)), "the span")
    plain = c.use(violation_during_taumod, *at, limits, begin, end)
    c.show(c.implies(c.any_of(es == 0, ez == 0, ev == 0, ew == 0), c.same(found, plain)), "none")
