"""When zones are in force: those of the mission, and those that appear or end in flight."""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.schedule.rows import runs_forward
from cratous.spec.mission import Mission, Zone
from cratous.spec.mission.changes import ZoneEnd


class Bound(NamedTuple):
    """A zone, and the times from and until which it is in force [ms]; None: to the end."""

    zone: Zone
    since_ms: int
    until_ms: int | None = None

    def binds(self, begin_ms: int) -> bool:
        """Whether a leg that begins at this instant must keep the zone: as a whole, even if the zone ends
        during it.
        """
        over = self.until_ms is not None and runs_forward(self.until_ms, begin_ms)
        return runs_forward(self.since_ms, begin_ms) and not over


def zones_of(mission: Mission, end_ms: int) -> list[Bound]:
    """The zones known before an instant, including those that have ended, each with its times.

    A change between two simulation instants takes effect at the later one: a zone that appears is in force
    from then on, one that ends until then.
    """
    step_ms = mission.simulation.step_ms
    times = [(c, -(-c.at_ms // step_ms) * step_ms) for c in mission.changes]
    ends = {c.zone_id: at for c, at in times if isinstance(c, ZoneEnd)}
    late = [(c.zone, at) for c, at in times if c.zone and not runs_forward(end_ms, at)]
    known = [*((zone, 0) for zone in mission.zones), *late]
    return [Bound(zone, since_ms, ends.get(zone.id)) for zone, since_ms in known]
