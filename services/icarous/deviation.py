"""Deviation of another aircraft from its predicted position."""

from __future__ import annotations

from cratous.core.avoidance.prediction import EXACT, Spread
from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.spec.mission import Daa, Position


def keeps_to(
    predicted: Position, now: Position, daa: Daa, told: Spread = EXACT, seen: Spread = EXACT
) -> bool:
    """Whether the deviation, horizontally and vertically, is within half of the buffer's margin; the other
    half is the own vehicle's.

    told, seen: uncertainty of the prediction and of the observation, added to that.
    """
    share, volume = (daa.buffer - 1) / 2, daa.well_clear
    beside = Vec2(now.north_m - predicted.north_m, now.east_m - predicted.east_m)
    above = Vec2(now.alt_m - predicted.alt_m, 0.0)
    return bool(
        disc_within(beside, 0.0, share * volume.dthr_m + told.wide_m + seen.wide_m)
        and disc_within(above, 0.0, share * volume.zthr_m + told.high_m + seen.high_m)
    )
