"""Distances and bearings on AMASE's earth model: spherical for navigation, WGS-84 radii for motion.

Latitudes, longitudes and bearings [rad], bearings clockwise from north; distances [m].
"""

from __future__ import annotations

from math import asin, atan2, cos, fmod, hypot, isnan, nan, pi, sin, sqrt

EQUATOR_M = 6378137.0
POLE_M = 6356752.31424518
ECCENTRICITY = 0.0818191908426

Place = tuple[float, float, float]
"""Latitude and longitude [rad], height [m MSL]."""


def bound_pi(angle_rad: float) -> float:
    """The angle normalised to [-pi, pi]."""
    if -pi <= angle_rad <= pi:
        return angle_rad
    angle = fmod(angle_rad, 2 * pi)
    if angle > pi:
        return angle - 2 * pi
    return angle + 2 * pi if angle < -pi else angle


def prime_vertical_m(lat_rad: float) -> float:
    """Radius of curvature in the prime vertical [m]."""
    along = ECCENTRICITY * sin(lat_rad)
    return EQUATOR_M / sqrt(1 - along * along)


def distance_m(lat: float, lon: float, to_lat: float, to_lon: float) -> float:
    """Great circle distance on a sphere of the equator's radius [m]."""
    a, b = sin((to_lat - lat) / 2), sin((to_lon - lon) / 2)
    return 2 * asin(min(1.0, sqrt(a * a + cos(lat) * cos(to_lat) * b * b))) * EQUATOR_M


def bearing_rad(lat: float, lon: float, to_lat: float, to_lon: float) -> float:
    """Initial bearing of the great circle from one point to another [rad]."""
    turn, c = to_lon - lon, cos(to_lat)
    return atan2(c * sin(turn), cos(lat) * sin(to_lat) - sin(lat) * c * cos(turn))


def horizon_m(height_m: float) -> float:
    """Distance of the horizon from a height above the sea [m]."""
    height = max(0.0, height_m)
    return sqrt(2 * EQUATOR_M * height + height * height)


def ahead(lat: float, lon: float, length_m: float, azimuth_rad: float) -> tuple[float, float]:
    """The point at a distance and bearing from another."""
    arc = length_m / EQUATOR_M
    s, c, north = sin(arc), cos(arc), cos(azimuth_rad)
    return (
        asin(max(-1.0, min(1.0, sin(lat) * c + cos(lat) * s * north))),
        lon + atan2(s * sin(azimuth_rad), cos(lat) * c - sin(lat) * s * north),
    )


def to_leg(
    start: tuple[float, float], end: tuple[float, float], lat: float, lon: float
) -> tuple[float, float]:
    """Distance and bearing from a point to the nearest point of a leg, on the tangent plane at the point."""
    scale = prime_vertical_m(lat) * cos(lat)
    x, y = (start[1] - lon) * scale, (start[0] - lat) * POLE_M
    dx, dy = (end[1] - start[1]) * scale, (end[0] - start[0]) * POLE_M
    square = dx * dx + dy * dy
    part = -(x * dx + y * dy) / square if square else nan
    if not isnan(part):
        part = min(1.0, max(0.0, part))
        x, y = x + part * dx, y + part * dy
    return hypot(x, y), atan2(x, y)
