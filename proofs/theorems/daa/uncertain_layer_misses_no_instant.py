"""Whatever altitude and climb rate within the uncertainty are the true ones: an instant of [0, T] at
which they violate the layer lies in the span."""

from cratous.core.daa.uncertainty import layer_above, layer_span
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    sz, vz, ez, ew, zthr, tcoa, vmod, end = c.reals("sz vz ez ew zthr tcoa vmod end")
    dz, dw, t = c.reals("dz dw t")
    for least in (zthr, tcoa, vmod, t):
        c.premise(least >= 0)
    c.premise(t <= end)
    c.opaque(layer_above)
    span = c.use(layer_span, sz, vz, ez, ew, zthr, tcoa, vmod, end)
    z, w = sz + dz, vz + dw
    names = ("low", "high", "slow", "fast", "zthr", "tcoa", "vmod", "end")
    seen = "daa_uncertain_layer_above_misses_no_instant"
    above, below = sz - ez >= 0, sz + ez < 0
    both = c.negation(c.any_of(above, below))
    # what the definition asks for
    near = c.all_of(-ez <= dz, dz <= ez, -ew <= dw, dw <= ew)
    sides = ((above, 1), (below, -1), (c.all_of(both, z >= 0), 1), (c.all_of(both, z < 0), -1))
    for (there, sign), args in zip(sides, c.calls(layer_above), strict=False):
        bounds = dict(zip(names, args, strict=True))
        c.lemma(seen, when=c.all_of(near, there), z=sign * z, w=sign * w, t=t, **bounds)
    state, off, error = (
        daa_meaning.Vertical(sz, vz),
        daa_meaning.Vertical(dz, dw),
        daa_meaning.Vertical(ez, ew),
    )
    violated = c.define(
        daa_meaning.layer_may_be_violated_at, state, off, error, zthr, tcoa, vmod, t
    )
    found = c.define(well_clear.in_span, *span, t)
    c.show(c.implies(violated, found))
