"""Vehicles that take no part in a mission at an instant, and why: lost, not joined yet, too much wind."""

from __future__ import annotations

import math
from collections.abc import Container

from cratous.services.mission.wind import Wind, in_wind, wind_at
from cratous.spec.mission import Mission, Vehicle
from cratous.spec.mission.changes import VEHICLE_JOINS, VEHICLE_LOST, split, without_vehicles
from cratous.spec.records import replace

JOINS_LATER = "joins only at"
"""Text for a vehicle that has not joined yet."""


def absent(mission: Mission, now_ms: int) -> dict[int, str]:
    """The vehicles that take no part at an instant, each with the reason."""
    away, wind = without_vehicles(mission, now_ms), wind_at(mission, now_ms)
    found = {}
    for vehicle in mission.vehicles:
        change = away.get(vehicle.id)
        if change is not None:
            lost = change.kind == VEHICLE_LOST
            at_ms = _lost_ms(mission, vehicle.id, now_ms) if lost else change.at_ms
            how = "was lost at" if lost else JOINS_LATER
            found[vehicle.id] = f"it {how} {at_ms / 1000:.2f} s"
        elif in_wind(vehicle, wind) is None:
            found[vehicle.id] = _too_windy(vehicle, wind)
    return found


def without(known: Mission, landed: Container[int]) -> Mission:
    """The mission without the vehicles that have landed."""
    here = tuple(vehicle for vehicle in known.vehicles if vehicle.id not in landed)
    return known if here == known.vehicles else replace(known, vehicles=here)


def _lost_ms(mission: Mission, vehicle_id: int, now_ms: int) -> int:
    """When a lost vehicle was lost [ms]: a lost vehicle is not lost again."""
    happened, _ = split((c for c in mission.changes if c.vehicle == vehicle_id), now_ms)
    before: list[int] = []
    for change in happened:
        if change.kind == VEHICLE_JOINS:
            before = []
        elif change.kind == VEHICLE_LOST:
            before.append(change.at_ms)
    return before[0]


def _too_windy(vehicle: Vehicle, wind: Wind) -> str:
    return (
        f"it can hold no speed over the ground in every direction in a wind of "
        f"{math.hypot(*wind):.4g} m/s, at {vehicle.min_speed_m_s:.4g} to "
        f"{vehicle.max_speed_m_s:.4g} m/s through the air"
    )
