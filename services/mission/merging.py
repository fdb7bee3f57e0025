"""The fix at which a mission's vehicles merge, and times that follow from it."""

from __future__ import annotations

import math

from cratous.spec.mission import CombinedDaa, MergingDaa, Mission
from cratous.spec.mission.merging import Merging

TOLERANCE_MS = 1000
"""How early or late a vehicle may be at its slot [ms]; slots are farther apart by twice this."""


def merging_of(mission: Mission) -> Merging | None:
    """The fix at which vehicles merge; None if the mission has none."""
    return mission.daa.merging if isinstance(mission.daa, MergingDaa | CombinedDaa) else None


def merges(mission: Mission, vehicle_id: int) -> Merging | None:
    """The fix at which a vehicle merges; None for none."""
    merging = merging_of(mission)
    return merging if merging is not None and vehicle_id in merging.vehicles else None


def apart_ms(merging: Merging) -> int:
    """Time between two slots [ms]."""
    return merging.separation_ms + 2 * TOLERANCE_MS


def merging_ms(mission: Mission, vehicle_id: int) -> int:
    """Longest time for which ICAROUS may fly a vehicle to merge [ms]; 0 if it does not merge.

    It is that across the coordination zone at the slowest speed, and a slot for each vehicle that merges.
    """
    merging = merges(mission, vehicle_id)
    if merging is None:
        return 0
    across_s = merging.coordination_m / mission.vehicle(vehicle_id).min_speed_m_s
    return math.ceil(1000 * across_s) + len(merging.vehicles) * apart_ms(merging)
