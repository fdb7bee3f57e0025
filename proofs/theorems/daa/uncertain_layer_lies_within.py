"""The span of an uncertain altitude lies within [0, T], or holds no instant."""

from cratous.core.daa.uncertainty import layer_above, layer_span
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    sz, vz, ez, ew, zthr, tcoa, vmod, end = c.reals("sz vz ez ew zthr tcoa vmod end")
    for least in (zthr, tcoa, vmod, end):
        c.premise(least >= 0)
    c.opaque(layer_above)
    first, last = c.use(layer_span, sz, vz, ez, ew, zthr, tcoa, vmod, end)
    names = ("low", "high", "slow", "fast", "zthr", "tcoa", "vmod", "end")
    for args in c.calls(layer_above):
        c.lemma("daa_uncertain_layer_above_lies_within", **dict(zip(names, args, strict=True)))
    c.show(c.implies(first <= last, c.all_of(first >= 0, last <= end)))
