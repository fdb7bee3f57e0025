"""When a ground speed can be held in a steady wind.

The wind is the velocity of the air over the ground (the direction it blows towards): north, east [m/s]. A direction
over the ground is a unit vector. Only arithmetic and comparisons are used, so that the definitions can be run on
numbers and on symbolic values alike.
"""

from __future__ import annotations


def airspeed_squared(
    north: float, east: float, ground_m_s: float, wind_north_m_s: float, wind_east_m_s: float
) -> float:
    """Square of the airspeed for a given ground speed in a direction over the ground [m^2/s^2]."""
    n = ground_m_s * north - wind_north_m_s
    e = ground_m_s * east - wind_east_m_s
    return n * n + e * e


def holds(
    north: float,
    east: float,
    ground_m_s: float,
    wind_north_m_s: float,
    wind_east_m_s: float,
    least_m_s: float,
    most_m_s: float,
) -> bool:
    """In the direction (north, east) the airspeed for this ground speed is within the limits.

    FOR ALL directions. Premises: the direction has length 1, no speed is below 0.
    """
    squared = airspeed_squared(north, east, ground_m_s, wind_north_m_s, wind_east_m_s)
    return least_m_s * least_m_s <= squared and squared <= most_m_s * most_m_s
