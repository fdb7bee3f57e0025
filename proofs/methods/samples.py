"""What theorems on a trace are about: any sample, and any instant and bounds that are asked for."""

from __future__ import annotations

from typing import Any

from cratous.proofs.claim import Claim

START = -(2**62)
"""Before every sample."""

Three = tuple[Any, Any, Any]


def any_sample(c: Claim) -> tuple[Three, Three]:
    """Any sample `time`, `phi`, `psi`, its verdicts 0 to 2; and any `at`, `low`, `high` in order from 0."""
    time, phi, psi = c.integer("time"), c.integer("phi"), c.integer("psi")
    at, low, high = c.integer("at"), c.integer("low"), c.integer("high")
    for verdict in (phi, psi):
        c.premise(verdict >= 0)
        c.premise(verdict <= 2)
    c.premise(low >= 0)
    c.premise(low <= high)
    return (time, phi, psi), (at, low, high)
