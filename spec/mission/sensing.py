"""Sensors of a mission: what its ICAROUS instances see of their own vehicle and of traffic, and how well.

A mission without them gives ICAROUS the exact states of all aircraft, which its report says.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class SensorKind(StrEnum):
    """gps: the own state; adsb: traffic, by its id; radar: traffic, without ids."""

    GPS = "gps"
    ADSB = "adsb"
    RADAR = "radar"


@dataclass(frozen=True)
class Sensor:
    """A sensor that every vehicle with an ICAROUS instance carries.

    horizontal_m, vertical_m, velocity_m_s: standard deviations of its errors, normal and independent: of north and
    east each, of altitude, of each component of the velocity. latency_ms: what it has measured comes so much later.
    drop_out: share of its measurements that do not come. range_m: horizontal distance up to which it sees, None: any.
    """

    kind: SensorKind
    horizontal_m: float
    vertical_m: float
    velocity_m_s: float
    latency_ms: int = 0
    period_ms: int = 1000
    drop_out: float = 0.0
    range_m: float | None = None


@dataclass(frozen=True)
class Sensing:
    """All sensors, and how tracks are made of what they measure.

    seed: another one draws other errors. sigmas: an aircraft is taken to be no farther from its track than so many
    standard deviations. confirm_hits, confirm_of: a track counts once so many measurements of so many updates have
    come. coast_ms: it ends so long after the last one. manoeuvre_m_s2: by how much traffic is expected to change
    its velocity in a second, beside small turns: the noise of the filter's model.
    """

    sensors: tuple[Sensor, ...]
    seed: int = 0
    sigmas: float = 4.0
    confirm_hits: int = 2
    confirm_of: int = 3
    coast_ms: int = 5000
    manoeuvre_m_s2: float = 0.1

    @property
    def gps(self) -> Sensor | None:
        """The sensor of the own state, if there is one."""
        return next((one for one in self.sensors if one.kind is SensorKind.GPS), None)

    @property
    def of_traffic(self) -> tuple[Sensor, ...]:
        """The sensors that see others."""
        return tuple(one for one in self.sensors if one.kind is not SensorKind.GPS)


EXACT_STATES = (
    "ICAROUS is given the exact states of its vehicle and of traffic (truth), not sensed ones"
)
"""What is said of a flight without sensors."""


def words(sensing: Sensing) -> str:
    """The sensors and how tracks are made of them in words, for reports."""
    sensors = "; ".join(map(_words, sensing.sensors))
    own = "" if sensing.gps else "; the own state is exact"
    return (
        f"ICAROUS is given sensed states, not the true ones (seed {sensing.seed}): {sensors}{own}; "
        f"tracks within {sensing.sigmas:g} standard deviations, shown after {sensing.confirm_hits} of "
        f"{sensing.confirm_of} updates, ended {sensing.coast_ms / 1000:g} s after the last, "
        f"manoeuvres of {sensing.manoeuvre_m_s2:g} m/s2"
    )


def _words(one: Sensor) -> str:
    reach = "" if one.range_m is None else f", up to {one.range_m:g} m"
    return (
        f"{one.kind} (standard deviations {one.horizontal_m:g} m beside, {one.vertical_m:g} m in altitude, "
        f"{one.velocity_m_s:g} m/s; every {one.period_ms / 1000:g} s, {one.latency_ms / 1000:g} s late, "
        f"{one.drop_out:.0%} lost{reach})"
    )
