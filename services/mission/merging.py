"""Where a mission's vehicles merge, if they do."""

from __future__ import annotations

import math

from cratous.spec.mission import MergingDaa, Mission
from cratous.spec.mission.merging import Merging

TOLERANCE_MS = 1000
"""A vehicle may be so much before or after its slot [ms]; slots are farther apart by twice as much."""


def merging_of(mission: Mission) -> Merging | None:
    """The fix at which vehicles merge; None where the mission has none."""
    return mission.daa.merging if isinstance(mission.daa, MergingDaa) else None


def merges(mission: Mission, vehicle_id: int) -> Merging | None:
    """The same for one vehicle; None where it is none of those that merge."""
    merging = merging_of(mission)
    return merging if merging is not None and vehicle_id in merging.vehicles else None


def apart_ms(merging: Merging) -> int:
    """How far slots are apart [ms]."""
    return merging.separation_ms + 2 * TOLERANCE_MS


def merging_ms(mission: Mission, vehicle_id: int) -> int:
    """For how long ICAROUS may fly a vehicle because it merges [ms]: across the coordination zone at its slowest, and while
    all others pass the fix before it; 0 where it does not merge."""
    merging = merges(mission, vehicle_id)
    if merging is None:
        return 0
    across_s = merging.coordination_m / mission.vehicle(vehicle_id).min_speed_m_s
    return math.ceil(1000 * across_s) + len(merging.vehicles) * apart_ms(merging)
