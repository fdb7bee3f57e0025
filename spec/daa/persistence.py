"""When a displayed resolution or preferred direction persists although another one is now nearer.

Advice that changes from instant to instant cannot be flown. So a displayed value persists for a time after the
direction was chosen, and after that while the change would be small; and it persists as long as its replacement would
keep a smaller separation (its recovery cylinder was reduced more often). Source: RTCA DO-365B, the DAIDALUS v2
reference manual (persistence_time, persistence_preferred_*).
"""

from __future__ import annotations


def still_new(age: float, persistence: float) -> bool:
    """The direction was chosen too recently to be changed."""
    return age < persistence


def small(change: float, least: float) -> bool:
    """The change is too small to be made."""
    return change < least


def costs_distance(before: int, now: int) -> bool:
    """The replacement keeps a smaller cylinder clear (more reductions); -1: it needs no recovery cylinder."""
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
    """An earlier resolution that still resolves the conflict persists: in the preferred direction if the change is
    early, small, or reduces separation; in the other direction if both are recoveries and the change reduces
    separation.
    """
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
    """The preferred direction persists: it was chosen recently, both directions need about the same change, or the
    other one reduces separation.
    """
    apart = max(up - down, down - up)
    return still_new(age, persistence) or small(apart, least) or costs_distance(preferred, other)
