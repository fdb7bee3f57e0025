"""Where an uncertain altitude may be on both sides, the span of the layer is the hull of two: of what is above
co-altitude, and of what is below."""

from cratous.core.daa.uncertainty import layer_above, layer_span, span_hull
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    sz, vz, ez, ew, zthr, tcoa, vmod, end = c.reals("sz vz ez ew zthr tcoa vmod end")
    low, high, slow, fast = sz - ez, sz + ez, vz - ew, vz + ew
    c.premise(low < 0)
    c.premise(high >= 0)
    c.opaque(layer_above, span_hull)
    limits = (zthr, tcoa, vmod, end)
    span = c.use(layer_span, sz, vz, ez, ew, *limits)
    above = c.use(layer_above, low - low, high, slow, fast, *limits)
    below = c.use(layer_above, low - low, 0 - low, 0 - fast, 0 - slow, *limits)
    c.show(c.same(span, c.use(span_hull, above, below)))
