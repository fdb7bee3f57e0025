"""Arbitrary angles for theorems on turns, as cosine and sine."""

from __future__ import annotations

from typing import Any

from cratous.proofs.claim import Claim


def any_angle(c: Claim, cosine: str, sine: str) -> tuple[Any, Any]:
    """The cosine and sine of an arbitrary angle, under these names."""
    cos, sin = c.reals(f"{cosine} {sine}")
    c.premise(cos * cos + sin * sin == 1)
    return cos, sin
