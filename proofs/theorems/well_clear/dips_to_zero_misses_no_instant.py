"""If the parabola kernel says that a t^2 + b t + c stays above zero on [0, h], it does so at every
instant of [0, h]; a and h are not below zero."""

from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    a, b, k, h, t = c.reals("a b c h t")
    c.premise(a >= 0)
    c.premise(h >= 0)
    c.premise(t >= 0)
    c.premise(t <= h)
    dips = c.use(dips_to_zero, a, b, k, h)
    c.show(c.implies(c.define(well_clear.parabola, a, b, k, t) <= 0, dips))
