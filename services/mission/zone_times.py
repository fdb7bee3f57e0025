"""When zones are in force: those of the mission, those that appear or end in flight, and those that move."""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeVar

from cratous.core.schedule.rows import runs_forward
from cratous.services.mission.moving_zones import moving_zones
from cratous.spec.mission import Mission, MovingZone, SweptZone, Zone
from cratous.spec.mission.changes import ZoneEnd

Z = TypeVar("Z")


class Bound(NamedTuple, Generic[Z]):
    """A zone, and the times from and until which it is in force [ms]; None: to the end."""

    zone: Z
    since_ms: int
    until_ms: int | None = None

    def binds(self, begin_ms: int) -> bool:
        """Whether a leg that begins at this instant must keep the zone: as a whole, even if the zone ends
        during it.
        """
        over = self.until_ms is not None and runs_forward(self.until_ms, begin_ms)
        return runs_forward(self.since_ms, begin_ms) and not over


def zones_of(mission: Mission, end_ms: int) -> list[Bound[Zone]]:
    """The standing zones known before an instant, including those that have ended, each with its times.

    A change between two simulation instants takes effect at the later one: a zone that appears is in force
    from then on, one that ends until then. A region of a moving zone is in force until the next one is.
    """
    step_ms = mission.simulation.step_ms
    times = [(c, -(-c.at_ms // step_ms) * step_ms) for c in mission.changes]
    ends = {c.zone_id: at for c, at in times if isinstance(c, ZoneEnd)}
    late = [(c.zone, at) for c, at in times if c.zone and not runs_forward(end_ms, at)]
    found: list[Bound[Zone]] = []
    until_ms = dict(ends)
    # from the last one: a region ends with the next one of its id
    for zone, since_ms in reversed([*((zone, 0) for zone in mission.zones), *late]):
        found.append(Bound(zone, since_ms, until_ms.get(zone.id)))
        if isinstance(zone, SweptZone):
            until_ms[zone.id] = since_ms
    return found[::-1]


def judged_zones(mission: Mission, end_ms: int) -> list[Bound[Zone] | Bound[MovingZone]]:
    """The zones that are guaranteed to be kept: as `zones_of`, but moving zones themselves, not their regions.

    Of a leg during which a moving zone is in force for a part only the whole is judged: it begins and ends with a step.
    """
    step_ms = mission.simulation.step_ms
    found: list[Bound[Zone] | Bound[MovingZone]] = [
        bound for bound in zones_of(mission, end_ms) if not isinstance(bound.zone, SweptZone)
    ]
    for moving in moving_zones(mission):
        since_ms = moving.from_ms // step_ms * step_ms
        until_ms = None if moving.until_ms is None else -(-moving.until_ms // step_ms) * step_ms
        if not since_ms or not runs_forward(end_ms, since_ms):
            found.append(Bound(moving, since_ms, until_ms))
    return found
