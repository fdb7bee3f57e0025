"""At every instant of [0, h] the vertical volume, by TCOA or VMOD, is violated exactly if the instant
lies in the window that the kernel gives; the window's scale is positive, and a window that is not
empty lies within [0, h]."""

from cratous.core.well_clear import layer_window
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, vmod, h, t = c.reals("sz vz zthr tcoa vmod h t")
    for nonnegative in (zthr, tcoa, vmod, t):
        c.premise(nonnegative >= 0)
    c.premise(t <= h)
    scale, first, last = c.use(layer_window, sz, vz, zthr, tcoa, vmod, h)
    c.show(scale > 0, "the scale is positive")
    c.show(
        c.implies(first <= last, c.all_of(first >= 0, last <= h * scale)),
        "a window that is not empty lies within [0, h]",
    )
    inside = c.all_of(first <= t * scale, t * scale <= last)
    violated = c.define(well_clear.layer_violation_at, sz, vz, zthr, tcoa, vmod, t)
    c.show(c.same(violated, inside), "violated exactly inside the window")
