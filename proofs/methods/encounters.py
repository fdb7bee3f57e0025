"""Arbitrary values for theorems on two aircraft in straight flight: relative states and thresholds."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim


def any_state(c: Claim) -> tuple[Any, Any, Any, Any]:
    """An arbitrary relative state: horizontal position `s` and velocity `v`, altitude `sz`, climb rate `vz`."""
    return c.vector("s"), c.vector("v"), c.real("sz"), c.real("vz")


def any_instants(c: Claim, names: str) -> list[Any]:
    """Arbitrary instants of these names, in chronological order."""
    instants = c.reals(names)
    for earlier, later in pairwise(instants):
        c.premise(earlier <= later)
    return instants


def any_in_the_plane(c: Claim) -> tuple[Any, Any, Any, Any]:
    """An arbitrary horizontal state `s` and `v`, and thresholds `dthr` and `tthr`, not negative."""
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr = c.reals("dthr tthr")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    return s, v, dthr, tthr


def any_thresholds(c: Claim) -> Thresholds:
    """Arbitrary thresholds of a volume in space, not negative: `dthr`, `zthr`, `tthr`, `tcoa`, `vmod`."""
    limits = Thresholds(*c.reals("dthr zthr tthr tcoa vmod"))
    for threshold in limits:
        c.premise(threshold >= 0)
    return limits


def any_loss(c: Claim) -> tuple[Any, Any, Any, Any, Thresholds]:
    """An arbitrary relative state, and thresholds of a volume in space that it may violate."""
    return *any_state(c), any_thresholds(c)


def by_name(limits: Thresholds) -> dict[str, Any]:
    """Thresholds under the names that theorems use, for lemmas."""
    dthr, zthr, tthr, tcoa, vmod = limits
    return {"dthr": dthr, "zthr": zthr, "tthr": tthr, "tcoa": tcoa, "vmod": vmod}


def any_by_tcoa(c: Claim) -> tuple[tuple[Any, Any, Any, Any], list[Any]]:
    """An arbitrary relative state, and thresholds of the standard, not negative: `dthr`, `zthr`, `tthr`, `tcoa`."""
    limits = c.reals("dthr zthr tthr tcoa")
    for threshold in limits:
        c.premise(threshold >= 0)
    return any_state(c), limits


def any_nested_thresholds(c: Claim) -> tuple[Thresholds, Thresholds]:
    """Arbitrary thresholds, not negative, and others that are not smaller, with a 2 appended to their names."""
    names = "dthr zthr tthr tcoa vmod"
    small, great = c.reals(names), c.reals(" ".join(name + "2" for name in names.split()))
    for low, high in zip(small, great, strict=True):
        c.premise(low >= 0)
        c.premise(low <= high)
    return Thresholds(*small), Thresholds(*great)


def any_cylinder(c: Claim) -> tuple[Any, Any, Any, Any, Any, Any]:
    """An arbitrary relative state `s`, `v`, `sz`, `vz`, and a cylinder `radius`, `half`, neither negative."""
    radius, half = c.reals("radius half")
    c.premise(radius >= 0)
    c.premise(half >= 0)
    return *any_state(c), radius, half
