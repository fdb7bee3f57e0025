"""What theorems on a rounded product are about."""

from __future__ import annotations

from typing import Any

from cratous.proofs.claim import Claim


def any_rounding(c: Claim) -> tuple[Any, Any, Any, Any]:
    """Any `value`, any `p` of the sizes, and any `unit` and `tiny` of rounding and underflow, both above 0."""
    value, p, unit, tiny = c.reals("value p unit tiny")
    c.premise(unit > 0)
    c.premise(tiny > 0)
    return value, p, unit, tiny
