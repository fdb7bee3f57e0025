"""The direct links between vehicles that merge at a fix, and the configuration of their ICAROUS instances for it.

A message sent at a heartbeat arrives at the next one, or is lost: as the mission's faults say, the same for the same
seed.
"""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator

from cratous.core.authority.timeliness import lasted
from cratous.core.kernel import Vec2
from cratous.services.icarous.merge_state import Fix
from cratous.services.icarous.merger import Talks
from cratous.services.icarous.messages import Talk, Tells
from cratous.services.mission.merging import apart_ms, merges, merging_of
from cratous.spec.mission import Mission


def merge_fix(mission: Mission, vehicle_id: int) -> Fix | None:
    """The fix at which a vehicle merges; None for none."""
    merging = merges(mission, vehicle_id)
    if merging is None:
        return None
    members = tuple(sorted(merging.vehicles))
    talks = Talks(members, vehicle_id, apart_ms(merging))
    place = Vec2(merging.north_m, merging.east_m)
    return Fix(
        merging.name, place, merging.coordination_m, merging.schedule_m, merging.entry_m, talks
    )


class DirectTalk:
    """The direct links: messages sent and not yet delivered."""

    def __init__(self, mission: Mission, instances: Collection[int]) -> None:
        merging = merging_of(mission)
        self._faults = None if merging is None else merging.faults
        self._members = [] if merging is None else sorted({*merging.vehicles} & {*instances})
        self._said: list[Tells] = []

    def tell(self, said: Tells) -> None:
        """Send a member's message to all others."""
        self._said.append(said)

    def come(self, now_ms: int) -> Iterator[tuple[int, Talk]]:
        """Messages delivered now, each with the id of its recipient."""
        said, self._said = self._said, []
        for one in said:
            for other in self._members:
                if other != one.vehicle_id and self._comes(one, other, now_ms):
                    yield other, Talk(now_ms, one.said)

    def _comes(self, one: Tells, other: int, now_ms: int) -> bool:
        faults = self._faults
        if faults is None:
            return True
        for who, from_ms, until_ms in faults.silences:
            if who not in (one.vehicle_id, other):
                continue
            if lasted(from_ms, now_ms, 0) and not lasted(until_ms, now_ms, 0):
                return False
        text = f"{faults.seed} {one.vehicle_id} {other} {now_ms}"
        drawn = int.from_bytes(hashlib.sha256(text.encode()).digest()[:6], "big") / 2**48
        return drawn >= faults.loss
