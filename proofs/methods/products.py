"""Arbitrary values for theorems on a rounded product."""

from __future__ import annotations

from typing import Any

from cratous.proofs.claim import Claim


def any_rounding(c: Claim) -> tuple[Any, Any, Any, Any]:
    """An arbitrary `value`, a product `p` of the sizes, and `unit` and `tiny` of rounding and underflow, both
    positive."""
    value, p, unit, tiny = c.reals("value p unit tiny")
    c.premise(unit > 0)
    c.premise(tiny > 0)
    return value, p, unit, tiny
