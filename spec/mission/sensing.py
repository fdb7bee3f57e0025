"""Sensors of a mission: what its ICAROUS instances measure of their own vehicle and of traffic, and how accurately.

A mission without sensors gives ICAROUS the exact states of all aircraft, which its report states.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class SensorKind(StrEnum):
    """gps: the vehicle's own state; adsb: traffic, by its id; radar: traffic, without ids."""

    GPS = "gps"
    ADSB = "adsb"
    RADAR = "radar"


@dataclass(frozen=True)
class Sensor:
    """A sensor carried by every vehicle with an ICAROUS instance.

    horizontal_m, vertical_m, velocity_m_s: standard deviations of its errors, normal and independent: of north and
    east each, of altitude, of each velocity component. latency_ms: delay of its measurements. drop_out: share of its
    measurements that are lost. range_m: maximum horizontal distance, None: unlimited.
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
    """All sensors, and how tracks are formed from their measurements.

    seed: of the errors. sigmas: an aircraft is assumed to be within this many standard deviations of its track.
    confirm_hits, confirm_of: a track is confirmed after this many measurements in this many updates. coast_ms: time
    after the last measurement at which a track ends. manoeuvre_m_s2: expected change of traffic velocity per second,
    besides small turns: the process noise of the filter.
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
        """The sensor of the vehicle's own state, if there is one."""
        return next((one for one in self.sensors if one.kind is SensorKind.GPS), None)

    @property
    def of_traffic(self) -> tuple[Sensor, ...]:
        """The sensors that measure other aircraft."""
        return tuple(one for one in self.sensors if one.kind is not SensorKind.GPS)


EXACT_STATES = (
    "ICAROUS is given the exact states of its vehicle and of traffic (truth), not sensed ones"
)
"""Report text for a flight without sensors."""


def words(sensing: Sensing) -> str:
    """The sensors and the forming of tracks in words, for reports."""
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
