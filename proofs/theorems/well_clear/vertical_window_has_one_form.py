"""The window's scale is the relative climb rate's size, or one where there is no climb; and without
climb a window that holds no instant is always the same one, from 1 to 0."""

from cratous.core.well_clear import vertical_window
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, h = c.reals("sz vz zthr tcoa h")
    for nonnegative in (zthr, tcoa, h):
        c.premise(nonnegative >= 0)
    scale, first, last = c.use(vertical_window, sz, vz, zthr, tcoa, h)
    level = vz == 0
    c.show(c.implies(level, scale == 1), "unscaled without climb")
    c.show(c.implies(c.negation(level), scale == c.when(vz > 0, vz, 0 - vz)), "scaled by the rate")
    never = c.all_of(level, first > last)
    c.show(c.implies(never, c.all_of(first == 1, last == 0)), "one empty window")
