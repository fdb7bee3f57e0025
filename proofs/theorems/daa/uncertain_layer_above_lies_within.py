"""The span of an altitude known to be on one side lies within [0, T], or holds no instant."""

from cratous.core.daa.uncertainty import layer_above
from cratous.core.well_clear.interval import vertical_interval
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    low, high, slow, fast, zthr, tcoa, vmod, end = c.reals("low high slow fast zthr tcoa vmod end")
    for least in (zthr, tcoa, vmod, end):
        c.premise(least >= 0)
    c.opaque(vertical_interval)
    first, last = c.use(layer_above, low, high, slow, fast, zthr, tcoa, vmod, end)
    names = ("sz", "vz", "zthr", "tcoa", "vmod", "begin", "end")
    for args in c.calls(vertical_interval):
        c.lemma("well_clear_vertical_interval_lies_within", **dict(zip(names, args, strict=True)))
    c.show(c.implies(first <= last, c.all_of(first >= 0, last <= end)))
