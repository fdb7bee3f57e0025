"""Theorems on whether a t^2 + b t + c reaches zero or less, for parabolas in general or only those open upwards."""

from __future__ import annotations

from typing import Any

from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def dip_has_a_witness(c: Claim, a: Any) -> None:
    """A parabola that reaches zero on [0, h] does so at 0, at h, or at the vertex, which is given by its equation.

    a: the coefficient `a`, with its premises; without a vertex (a <= 0) its value is arbitrary.
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
