"""The span for uncertain states is the hull of two: of the volume's own, and of the instants of [B, T] that
the spans of altitude and circle share."""

from cratous.core.daa.uncertainty import (
    Uncertainty,
    circle_span,
    layer_span,
    span_hull,
    uncertain_span,
)
from cratous.core.well_clear.interval import or_empty, violation_interval_taumod
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    limits = Thresholds(*c.reals("dthr zthr tthr tcoa vmod"))
    dthr, zthr, tthr, tcoa, vmod = limits
    es, ez, ev, ew, begin, end = c.reals("es ez ev ew begin end")
    c.opaque(violation_interval_taumod, circle_span, layer_span, span_hull)
    span = c.use(uncertain_span, s, v, sz, vz, Uncertainty(es, ez, ev, ew), limits, begin, end)
    own = c.use(violation_interval_taumod, s, v, sz, vz, limits, begin, end)
    layer = c.use(layer_span, sz, vz, ez, ew, zthr, tcoa, vmod, end)
    circle = c.use(circle_span, s, v, es, ev, dthr, tthr, end)
    first = c.when(layer.first_s >= circle.first_s, layer.first_s, circle.first_s)
    last = c.when(layer.last_s <= circle.last_s, layer.last_s, circle.last_s)
    first, last = c.when(first >= begin, first, begin), c.when(last <= end, last, end)
    shared = c.use(or_empty, first, last)
    for args in c.calls(span_hull):
        c.congruence(span_hull, (own, shared), args)
    c.show(c.same(span, c.use(span_hull, own, shared)))
