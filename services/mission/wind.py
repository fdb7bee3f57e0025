"""Ground speeds in the known wind that an aircraft can hold in every direction.

Plans and flights use ground speeds. In wind a vehicle's limits, which are airspeeds, narrow to the ground
speeds that `core.routing.wind.holds_in_wind` admits; it keeps its own speed if that is one of them, else the
nearest. A vehicle without any takes no part during such wind.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from cratous.core.routing.wind import holds_in_wind
from cratous.spec.mission import Mission, Vehicle, changes
from cratous.spec.mission.changes import WindChange

Wind = tuple[float, float]
CALM = (0.0, 0.0)
NUDGE = 1e-9
"""Limits are narrowed by this additional share, since the wind's strength is rounded."""


def wind_at(mission: Mission, now_ms: int) -> Wind:
    """The wind known at an instant: north, east [m/s]."""
    happened, _ = changes.split(mission.changes, now_ms)
    blown = [(c.north_m_s, c.east_m_s) for c in happened if isinstance(c, WindChange)]
    return blown[-1] if blown else CALM


def in_wind(vehicle: Vehicle, wind: Wind) -> Vehicle | None:
    """The vehicle with its ground speed limits; None if it can hold no speed."""
    if wind == CALM:
        return vehicle
    least, most = vehicle.min_speed_m_s, vehicle.max_speed_m_s
    strength = math.hypot(*wind) * (1 + NUDGE)
    slowest, fastest = (least + strength) * (1 + NUDGE), (most - strength) * (1 - NUDGE)
    ends = (slowest, fastest)
    if slowest > fastest or not all(holds_in_wind(v, *wind, least, most) for v in ends):
        return None
    speed = min(max(vehicle.speed_m_s, slowest), fastest)
    return replace(vehicle, speed_m_s=speed, min_speed_m_s=slowest, max_speed_m_s=fastest)


def all_in_wind(mission: Mission, wind: Wind) -> Mission:
    """The mission with all vehicles in the wind; those that can hold no speed are unchanged."""
    vehicles = tuple(in_wind(v, wind) or v for v in mission.vehicles)
    return mission if wind == CALM else replace(mission, vehicles=vehicles)


def known_at(mission: Mission, now_ms: int, done: Iterable[int] = ()) -> Mission:
    """As `spec.mission.changes.known_at`, in the wind of that instant."""
    known, wind = changes.known_at(mission, now_ms, done), wind_at(mission, now_ms)
    if wind == CALM:
        return known
    able = tuple(v for vehicle in known.vehicles if (v := in_wind(vehicle, wind)) is not None)
    return replace(known, vehicles=able)


def told(mission: Mission, before: Wind, now: Wind) -> str:
    """What a change of wind means for the vehicles, in words; "" if nothing."""
    parts = []
    for vehicle in mission.vehicles:
        old, new = in_wind(vehicle, before), in_wind(vehicle, now)
        if new is None:
            if old is not None:
                parts.append(
                    f"vehicle {vehicle.id} can hold no speed over the ground in every direction"
                )
        elif old is None or old.speed_m_s != new.speed_m_s:
            was = "" if old is None else f" instead of {old.speed_m_s:.4g}"
            parts.append(f"vehicle {vehicle.id} holds {new.speed_m_s:.4g} m/s over the ground{was}")
    return ", ".join(parts)
