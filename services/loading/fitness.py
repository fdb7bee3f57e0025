"""Warns of valid parameters that do not suit the vehicles; the warnings are kept in the report.

A number is unsuitable if the values that ICAROUS derives from vehicle and mission
(`services.icarous.derived`) require another. No verdict depends on it: the flight is monitored as
usual.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from cratous.spec.mission import Mission, Vehicle
from cratous.spec.mission.changes import ZONE

NAME = "parameter does not fit"
BELOW = "that is the terrain, and it would fly its tasks below it"
CLIMB = (
    "within the look-ahead it cannot climb out of the volume, so it avoids by turns and speed alone"
)
EMPTY = "a volume of no size is lost only by a collision of two points"
STEPS = "nothing happens between two steps of the simulation, so heartbeats would be late"


class Need(NamedTuple):
    """A requirement on a parameter: item, value, minimum, maximum, unit, and reason."""

    item: str
    got: float
    least: float
    most: float
    unit: str
    why: str

    @property
    def met(self) -> bool:
        """Whether the value is within its limits."""
        return self.least <= self.got <= self.most

    @property
    def text(self) -> str:
        """The unmet requirement as text for notes."""
        high = self.got > self.most
        bound, wanted = "at most" if high else "at least", self.most if high else self.least
        wanted = wanted if high else _rounded_up(wanted)
        got, asked = (f"{x:g} {self.unit}".strip() for x in (self.got, wanted))
        return f"{NAME}: {self.item} is {got}, expected {bound} {asked}: {self.why}"


def warnings_of(mission: Mission) -> tuple[str, ...]:
    """Unsuitable parameters for the vehicles with an ICAROUS instance; one line per parameter."""
    worst = dict[str, Need]()
    for need in _needs(mission):
        before = worst.get(need.item)
        if not need.met and (before is None or need.least > before.least):
            worst[need.item] = need
    return tuple(need.text for need in worst.values())


def _needs(mission: Mission) -> Iterator[Need]:
    guarded = [vehicle for vehicle in mission.vehicles if vehicle.id in mission.instances]
    for vehicle in guarded:
        yield from _of_vehicle(mission, vehicle)
    if guarded:
        yield from _of_mission(mission)


def _of_vehicle(mission: Mission, vehicle: Vehicle) -> Iterator[Need]:
    # imported here: not needed for missions without ICAROUS
    from cratous.services.icarous.derived import derived
    from cratous.services.icarous.traffic_monitor import PERSIST_MS

    daa, who, of = mission.daa, f"vehicle {vehicle.id}", derived(mission, vehicle)
    lookahead_s, volume = daa.lookahead_s, daa.well_clear
    why = (
        f"a predicted loss counts after {PERSIST_MS / 1000:g} s, and {who} needs "
        f"{of.hard_limit_s:.1f} s for a turn of 90 degrees and two heartbeats"
    )
    yield Need("daa.lookahead_s", lookahead_s, of.least_lookahead_s, math.inf, "s", why)
    if mission.zones or any(change.kind == ZONE for change in mission.changes):
        why = f"{who} needs so long to turn back before a zone"
        yield Need("daa.lookahead_s", lookahead_s, of.turn_back_s, math.inf, "s", why)
    if volume.dthr_m:
        least = 1 + 2 * of.drift_m / volume.dthr_m
        why = (
            f"half of what it leaves, {of.room_m:.3g} m, is for {who}, which may be "
            f"{of.drift_m:.3g} m off its predicted way in a turn of 90 degrees"
        )
        yield Need("daa.buffer", daa.buffer, least, math.inf, "", why)
    k, least = mission.vehicles.index(vehicle), daa.buffer * volume.zthr_m / lookahead_s
    item = f"vehicles[{k}].max_climb_m_s"
    yield Need(item, vehicle.max_climb_m_s, least, math.inf, "m/s", CLIMB)
    item, terrain_m = f"vehicles[{k}].cruise_m", mission.frame.terrain_m
    yield Need(item, vehicle.cruise_alt_m, terrain_m, math.inf, "m", BELOW)


def _of_mission(mission: Mission) -> Iterator[Need]:
    from cratous.services.icarous.instance import LINK_LOST_MS

    simulation, volume = mission.simulation, mission.daa.well_clear
    item, beat_ms, lost_s = "simulation.heartbeat_ms", simulation.heartbeat_ms, LINK_LOST_MS / 1000
    why = f"the bridge counts as lost after {lost_s:g} s, so with one heartbeat that is late"
    yield Need(item, beat_ms, 0, LINK_LOST_MS / 2, "ms", why)
    yield Need(item, beat_ms, simulation.step_ms, math.inf, "ms", STEPS)
    for name, value in (("dthr_m", volume.dthr_m), ("zthr_m", volume.zthr_m)):
        if not value:
            yield Need(f"daa.well_clear.{name}", value, 1.0, math.inf, "m", EMPTY)


def _rounded_up(value: float) -> float:
    """Rounded up to three significant digits, so that the requested value suffices."""
    if value <= 0:
        return value
    scale = 10.0 ** (2 - math.floor(math.log10(value)))
    return math.ceil(value * scale - 1e-9) / scale
