"""The span for uncertain states is the hull of two: of the volume's own, and of the instants of [B, T] that
the spans of altitude and circle share."""

from cratous.core.daa.uncertainty import circle_span, layer_span, span_hull, uncertain_span
from cratous.core.well_clear.interval import or_empty, violation_interval_taumod
from cratous.proofs.claim import Claim
from cratous.proofs.methods.uncertainty import any_uncertain, spans_of


def claim(c: Claim) -> None:
    asked = any_uncertain(c)
    begin, end = asked.begin, asked.end
    c.opaque(violation_interval_taumod, circle_span, layer_span, span_hull)
    span = c.use(uncertain_span, *asked)
    own, layer, circle = spans_of(c, asked)
    first = c.when(layer.first_s >= circle.first_s, layer.first_s, circle.first_s)
    last = c.when(layer.last_s <= circle.last_s, layer.last_s, circle.last_s)
    first, last = c.when(first >= begin, first, begin), c.when(last <= end, last, end)
    shared = c.use(or_empty, first, last)
    for args in c.calls(span_hull):
        c.congruence(span_hull, (own, shared), args)
    c.show(c.same(span, c.use(span_hull, own, shared)))
