"""Theorems on whether a t^2 + b t + c reaches zero or less, for parabolas of any sign or open upwards alone."""

from __future__ import annotations

from typing import Any

from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def dip_has_a_witness(c: Claim, a: Any) -> None:
    """What dips to zero on [0, h] does so at 0, at h, or at the vertex, which its equation names.

    a: the coefficient `a`, with what is known of it; without a vertex (a <= 0) any value does as one.
    """
    b, k, h, vertex = c.reals("b c h vertex")
    c.premise(h >= 0)
    c.premise(c.implies(a > 0, 2 * a * vertex + b == 0))
    dips = c.use(dips_to_zero, a, b, k, h)
    reached = [
        c.all_of(t >= 0, t <= h, c.define(well_clear.parabola, a, b, k, t) <= 0)
        for t in (a - a, h, vertex)
    ]
    c.show(c.implies(dips, c.any_of(*reached)))
