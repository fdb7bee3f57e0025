"""When a resolution, or the preferred direction, that is shown stays although another is nearer now.

An advice that changes from instant to instant cannot be flown. So what is shown stays for a time after
the direction was chosen, and after that while the change would be small; and it stays as long as what
would take its place keeps a smaller distance (its recovery cylinder was shrunk more often).
Source: RTCA DO-365B, the DAIDALUS v2 reference manual (persistence_time, persistence_preferred_*).
"""

from __future__ import annotations


def still_new(age: float, persistence: float) -> bool:
    """The direction was chosen too short a time ago to be changed."""
    return age < persistence


def small(change: float, least: float) -> bool:
    """A change that is not worth it."""
    return change < least


def costs_distance(before: int, now: int) -> bool:
    """What would take its place keeps a smaller cylinder clear; -1: it needs no cylinder."""
    return now > before


def kept(
    preferred: bool,
    before: int,
    now: int,
    age: float,
    persistence: float,
    beyond: float,
    least: float,
) -> bool:
    """An earlier resolution, which still resolves, stays: of the preferred direction because the
    change is early, small, or costs distance; of the other one if both are recoveries and the change
    costs distance."""
    stays = still_new(age, persistence) or small(beyond, least) or costs_distance(before, now)
    recovers = before > -1 and costs_distance(before, now)
    return recovers or (preferred and stays)


def direction_kept(
    age: float,
    persistence: float,
    up: float,
    down: float,
    least: float,
    preferred: int,
    other: int,
) -> bool:
    """The preferred direction stays: it is new, both ways are about as far, or the other one costs
    distance."""
    apart = max(up - down, down - up)
    return still_new(age, persistence) or small(apart, least) or costs_distance(preferred, other)
