"""Arbitrary encounters of one vehicle with one intruder."""

from __future__ import annotations

from cratous.core.permit.encounter import Encounter
from cratous.proofs.claim import Claim


def any_encounter(c: Claim, name: str) -> Encounter:
    """An arbitrary encounter; `name` is the prefix of the names of its parts."""
    return Encounter(
        c.integer(f"{name}takeovers"),
        c.integer(f"{name}surprises"),
        c.integer(f"{name}ended"),
        c.boolean(f"{name}avoiding"),
        c.boolean(f"{name}permitted"),
        c.integer(f"{name}expiry"),
    )
