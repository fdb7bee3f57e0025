"""Where a mission's vehicles merge, if they do."""

from __future__ import annotations

from cratous.spec.mission import MergingDaa, Mission
from cratous.spec.mission.merging import Merging


def merging_of(mission: Mission) -> Merging | None:
    """The fix at which vehicles merge; None where the mission has none."""
    return mission.daa.merging if isinstance(mission.daa, MergingDaa) else None


def merges(mission: Mission, vehicle_id: int) -> Merging | None:
    """The same for one vehicle; None where it is none of those that merge."""
    merging = merging_of(mission)
    return merging if merging is not None and vehicle_id in merging.vehicles else None
