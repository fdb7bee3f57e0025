"""How long the link between UxAS and ICAROUS may be silent, and a vehicle may circle without it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class BridgeTimes:
    """lost_link_after_ms: silence after which a vehicle that ICAROUS has is without the link, where the mission has no
    `link_loss` [ms]; safe_state_after_ms: a vehicle that has circled without the link for this long is in the declared
    safe state [ms].
    """

    lost_link_after_ms: int = 30_000
    safe_state_after_ms: int = 120_000


USUAL = BridgeTimes()
"""Of a mission that sets none."""


def words(times: BridgeTimes) -> str:
    """The times in words, for reports."""
    lost_s, safe_s = times.lost_link_after_ms / 1000, times.safe_state_after_ms / 1000
    return (
        f"the link of a vehicle that ICAROUS has counts as lost after {lost_s:g} s of silence; "
        f"one that has circled without it for {safe_s:g} s is in the declared safe state"
    )
