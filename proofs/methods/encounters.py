"""What theorems on two aircraft in straight flight are about: any relative state, any thresholds."""

from __future__ import annotations

from typing import Any

from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim


def any_state(c: Claim) -> tuple[Any, Any, Any, Any]:
    """Any relative state: horizontal position `s` and velocity `v`, altitude `sz`, climb rate `vz`."""
    return c.vector("s"), c.vector("v"), c.real("sz"), c.real("vz")


def any_in_the_plane(c: Claim) -> tuple[Any, Any, Any, Any]:
    """Any horizontal state `s` and `v`, and any thresholds `dthr` and `tthr`, none below 0."""
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr = c.reals("dthr tthr")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    return s, v, dthr, tthr


def any_thresholds(c: Claim) -> Thresholds:
    """Any thresholds of a volume in space, none below 0: `dthr`, `zthr`, `tthr`, `tcoa`, `vmod`."""
    limits = Thresholds(*c.reals("dthr zthr tthr tcoa vmod"))
    for threshold in limits:
        c.premise(threshold >= 0)
    return limits


def by_name(limits: Thresholds) -> dict[str, Any]:
    """Thresholds under the names that theorems give them, for lemmas."""
    dthr, zthr, tthr, tcoa, vmod = limits
    return {"dthr": dthr, "zthr": zthr, "tthr": tthr, "tcoa": tcoa, "vmod": vmod}
