"""At every instant of [0, h] the vertical volume is violated exactly if the instant lies in the
window that the kernel gives; the window's scale is positive, and a window that is not empty lies
within [0, h]."""

from cratous.core.well_clear import vertical_window
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, h, t = c.reals("sz vz zthr tcoa h t")
    for nonnegative in (zthr, tcoa, t):
        c.premise(nonnegative >= 0)
    c.premise(t <= h)
    scale, first, last = c.use(vertical_window, sz, vz, zthr, tcoa, h)
    c.show(scale > 0, "the scale is positive")
    c.show(
        c.implies(first <= last, c.all_of(first >= 0, last <= h * scale)),
        "a window that is not empty lies within [0, h]",
    )
    inside = c.all_of(first <= t * scale, t * scale <= last)
    violated = c.define(well_clear.vertical_violation_at, sz, vz, zthr, tcoa, t)
    c.show(c.same(violated, inside), "violated exactly inside the window")
