"""Loiters: circle, racetrack, figure eight and hover, as courses to fly.

Racetrack and figure eight are a cycle of four: turn, leg, turn, leg; a turn is flown about its centre and a
leg to its end, and each is complete when it lies abeam along the axis.
"""

from __future__ import annotations

from math import cos, pi, radians
from typing import Any, NamedTuple

from cratous.services.simulator.earth import ahead, bearing_rad, distance_m

CIRCLE, RACETRACK, FIGURE_EIGHT, HOVER = range(4)
HOVER_GAIN_S = 0.5
"""Approach speed of a hovering vehicle per distance from its place [1/s]."""


class Loiter(NamedTuple):
    """kind; points [rad]: the centre, or turn, leg, turn, leg; radius [m]; axis [rad]; clockwise; altitude [m
    MSL], airspeed [m/s], duration [s], 0 for unlimited.
    """

    kind: int
    points: tuple[tuple[float, float], ...]
    radius_m: float
    axis_rad: float
    clockwise: bool
    alt_m: float
    speed_m_s: float
    duration_s: float


def loiter_of(action: Any, min_speed_m_s: float, compatible: bool) -> Loiter:
    """The loiter of a LoiterAction.

    AMASE has no hover and shifts the circle of type VehicleDefault; without compatibility an airframe hovers
    if it can (its lowest speed is 0) and circles otherwise.
    """
    place = action.Location
    centre = radians(place.Latitude), radians(place.Longitude)
    axis, half = radians(action.Axis), action.Length / 2
    kind = {"Racetrack": RACETRACK, "FigureEight": FIGURE_EIGHT, "Hover": HOVER}.get(
        action.LoiterType.name, CIRCLE
    )
    if kind == HOVER and (compatible or min_speed_m_s > 0):
        kind = CIRCLE
    if kind == CIRCLE and compatible and action.LoiterType.name == "VehicleDefault":
        centre = ahead(*centre, half, axis)
    clockwise = action.Direction.name != "CounterClockwise"
    points: tuple[tuple[float, float], ...] = (centre,)
    if kind in (RACETRACK, FIGURE_EIGHT):
        half += action.Radius if kind == FIGURE_EIGHT else 0
        one, two = ahead(*centre, half, axis), ahead(*centre, half, axis + pi)
        right = pi / 2 if clockwise else -pi / 2
        # the eight crosses at its centre, so both legs begin on the same side
        first = right if kind == RACETRACK else -right
        points = (
            one,
            ahead(*two, action.Radius, axis + first),
            two,
            ahead(*one, action.Radius, axis - right),
        )
    return Loiter(
        kind,
        points,
        action.Radius,
        axis,
        clockwise,
        place.Altitude,
        action.Airspeed,
        # AMASE takes the message's milliseconds for seconds
        float(action.Duration) if compatible else action.Duration / 1000,
    )


def first_corner(loiter: Loiter, lat: float, lon: float, compatible: bool) -> int:
    """The first corner of a cycle: the nearest point (AMASE: the last one nearer than the first)."""
    away = [distance_m(*point, lat, lon) for point in loiter.points]
    if not compatible:
        return away.index(min(away))
    return max((k for k in range(1, len(away)) if away[k] < away[0]), default=0)


def circle_course_rad(
    centre: tuple[float, float], radius_m: float, clockwise: bool, lat: float, lon: float
) -> float:
    """Course onto a circle [rad]: straight to its centre beyond two radii, tangential on it."""
    course = bearing_rad(lat, lon, *centre)
    away = distance_m(lat, lon, *centre)
    if away > 2 * radius_m or radius_m == 0:
        return course
    inside = (2 * radius_m - away) / radius_m
    return course + (-pi / 2 if clockwise else pi / 2) * inside


def course(loiter: Loiter, corner: int, lat: float, lon: float) -> tuple[float, int]:
    """The course to fly [rad], and the next corner of the cycle."""
    point = loiter.points[corner]
    if loiter.kind == HOVER:
        return bearing_rad(lat, lon, *point), corner
    if loiter.kind == CIRCLE:
        return circle_course_rad(point, loiter.radius_m, loiter.clockwise, lat, lon), corner
    to_point = bearing_rad(lat, lon, *point)
    flown = to_point
    if corner in (0, 2):
        clockwise = loiter.clockwise
        if corner == 2 and loiter.kind == FIGURE_EIGHT:
            clockwise = not clockwise
        flown = circle_course_rad(point, loiter.radius_m, clockwise, lat, lon)
    along = cos(to_point - loiter.axis_rad)
    done = along > 0 if corner < 2 else along < 0
    return flown, (corner + 1) % 4 if done else corner
