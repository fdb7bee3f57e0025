"""Measurements of a vehicle's sensors: the truth with errors, latency and drop-outs.

Each error is drawn from its own context only (seeds, sensor, carrier, target and time), so that the same
mission gives the same errors, and another aircraft does not change those of the others.
"""

from __future__ import annotations

from collections.abc import Mapping
from random import Random
from typing import NamedTuple

from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.services.sensing.filter import Flown, Measured, measured
from cratous.spec.mission import Position, Velocity
from cratous.spec.mission.sensing import Sensing, Sensor, SensorKind


class Detection(NamedTuple):
    """A measurement, and when it arrives [ms]. sensor: index in the mission; name: the id that it reports, 0
    for none; source: its true target, unknown to the vehicle.
    """

    due_ms: int
    sensor: int
    name: int
    source: int
    seen: Measured


def detections(
    sensing: Sensing,
    seed: int,
    own_id: int,
    at_ms: int,
    step_ms: int,
    aircraft: Mapping[int, Flown],
) -> tuple[Detection, ...]:
    """The measurements of a vehicle's sensors at a simulation step. seed: of the mission's variant."""
    found = []
    for k, sensor in enumerate(sensing.sensors):
        # the first step in each of its periods
        if at_ms % sensor.period_ms not in range(step_ms):
            continue
        for other, air in aircraft.items():
            own = sensor.kind is SensorKind.GPS
            if own != (other == own_id) or not _reaches(sensor, aircraft[own_id], air):
                continue
            draw = Random(f"{seed} {sensing.seed} {k} {own_id} {other} {at_ms}")
            if draw.random() < sensor.drop_out:
                continue
            name = other if sensor.kind is SensorKind.ADSB else 0
            seen = _with_errors(draw, sensor, at_ms, air)
            found.append(Detection(at_ms + sensor.latency_ms, k, name, other, seen))
    return tuple(found)


def _reaches(sensor: Sensor, own: Flown, other: Flown) -> bool:
    if sensor.range_m is None:
        return True
    p, q = own.position, other.position
    off = Vec2(q.north_m - p.north_m, q.east_m - p.east_m)
    return bool(disc_within(off, 0.0, sensor.range_m))


def _with_errors(draw: Random, sensor: Sensor, at_ms: int, air: Flown) -> Measured:
    p, v = air.position, air.velocity
    wide, high, fast = sensor.horizontal_m, sensor.vertical_m, sensor.velocity_m_s
    place = Position(
        p.north_m + draw.gauss(0, wide),
        p.east_m + draw.gauss(0, wide),
        p.alt_m + draw.gauss(0, high),
    )
    velocity = Velocity(*(one + draw.gauss(0, fast) for one in v))
    return measured(sensor, at_ms, place, velocity)
