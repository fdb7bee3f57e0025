"""Which vehicles take no part in a mission at an instant, and why: lost, not there yet, too much wind."""

from __future__ import annotations

import math

from cratous.services.mission.wind import Wind, in_wind, wind_at
from cratous.spec.mission import Mission, Vehicle
from cratous.spec.mission.changes import VEHICLE_LOST, without_vehicles


def absent(mission: Mission, now_ms: int) -> dict[int, str]:
    """The vehicles that take no part at an instant, each with the reason."""
    away, wind = without_vehicles(mission, now_ms), wind_at(mission, now_ms)
    found = {}
    for vehicle in mission.vehicles:
        change = away.get(vehicle.id)
        if change is not None:
            how = "was lost at" if change.kind == VEHICLE_LOST else "joins only at"
            found[vehicle.id] = f"it {how} {change.at_ms / 1000:.2f} s"
        elif in_wind(vehicle, wind) is None:
            found[vehicle.id] = _too_windy(vehicle, wind)
    return found


def _too_windy(vehicle: Vehicle, wind: Wind) -> str:
    return (
        f"it can hold no speed over the ground in every direction in a wind of "
        f"{math.hypot(*wind):.4g} m/s, at {vehicle.min_speed_m_s:.4g} to "
        f"{vehicle.max_speed_m_s:.4g} m/s through the air"
    )
