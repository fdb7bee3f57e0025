"""The window's scale is the relative climb rate's size, or one where there is no climb; without climb
a window that holds no instant is always from 1 to 0; with VMOD off it is the window by TCOA."""

from cratous.core.well_clear import layer_window, vertical_window
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, vmod, h = c.reals("sz vz zthr tcoa vmod h")
    for nonnegative in (zthr, tcoa, vmod, h):
        c.premise(nonnegative >= 0)
    window = c.use(layer_window, sz, vz, zthr, tcoa, vmod, h)
    scale, first, last = window
    level = vz == 0
    c.show(c.implies(level, scale == 1), "unscaled without climb")
    c.show(c.implies(c.negation(level), scale == c.when(vz > 0, vz, 0 - vz)), "scaled by the rate")
    never = c.all_of(level, first > last)
    c.show(c.implies(never, c.all_of(first == 1, last == 0)), "one empty window")
    by_tcoa = c.use(vertical_window, sz, vz, zthr, tcoa, h)
    c.show(c.implies(vmod == 0, c.same(window, by_tcoa)), "by TCOA alone")
