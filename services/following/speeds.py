"""Speeds of a vehicle in a rendezvous, over ground and through the air, and its waiting laps."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.services.planning.performance_classes import Flyer
from cratous.spec.errors import BadInput
from cratous.spec.mission import Vehicle

LEAST_M_S = 1.0
"""Assumed lowest ground speed against the wind [m/s]."""
SLOWER = 2.0
"""A waiting vehicle flies at least its nominal speed divided by this, so that a state arrives in each quarter
of a lap.
"""
BRISK = 0.95
"""Share of the greatest speed at which a vehicle's approach is planned; the rest makes up for delays."""


class Limits(NamedTuple):
    """Speeds of a vehicle [m/s]. brisk: planned approach speed."""

    slowest_m_s: float
    nominal_m_s: float
    brisk_m_s: float
    fastest_m_s: float


def limits_of(vehicle: Vehicle) -> Limits:
    """The speeds of a vehicle; those missing in its configuration are the nominal one."""
    nominal = vehicle.speed_m_s
    slowest = min(vehicle.min_speed_m_s or nominal, nominal)
    fastest = max(vehicle.max_speed_m_s, nominal)
    return Limits(slowest, nominal, max(BRISK * fastest, nominal), fastest)


def wind_of(state: Any, heading_rad: float) -> Vec2:
    """The wind in a vehicle's state, along and across a heading [m/s]; BadInput for non-finite values."""
    speed, source = getattr(state, "WindSpeed", 0.0), getattr(state, "WindDirection", 0.0)
    if not (math.isfinite(speed) and math.isfinite(source)):
        raise BadInput(
            "a wind that is no number", where=f"state of vehicle {state.ID}",
            item="WindSpeed, WindDirection", expected="finite numbers", got=f"{speed:g}, {source:g}",
        )  # fmt: skip
    off = math.radians(source) - heading_rad
    return Vec2(-speed * math.cos(off), -speed * math.sin(off))


def over_ground(limits: Limits, wind: Vec2) -> Limits:
    """The speeds of a vehicle over ground, at least `LEAST_M_S`. wind: along and across its way [m/s]."""
    found = []
    for speed in limits:
        along = math.sqrt(max(speed**2 - wind.y**2, 0.0))
        found.append(max(along + wind.x, LEAST_M_S))
    return Limits(*found)


def lap_s(flyer: Flyer, wind: Vec2 = Vec2(0.0, 0.0)) -> float:
    """Duration of a waiting lap [s]; in wind at most ten times that without."""
    calm_s = 2 * math.pi * flyer.radius_m / flyer.speed_m_s
    return calm_s / max(1 - (wind.x**2 + wind.y**2) / flyer.speed_m_s**2, 0.1)


def waiting_of(flyer: Flyer, limits: Limits, wind: Vec2) -> Flyer:
    """The flyer while waiting: as slow as possible, on the smaller circle, if a lap is shorter that way."""
    share = max(limits.slowest_m_s / limits.nominal_m_s, 1 / SLOWER)
    slow = flyer._replace(
        speed_m_s=share * flyer.speed_m_s, radius_m=share * share * flyer.radius_m
    )
    return min(flyer, slow, key=lambda one: lap_s(one, wind))
