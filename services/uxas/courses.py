"""Vector fields that guide an aircraft onto a line or a circle.

Source: D. R. Nelson, D. B. Barber, T. W. McLain, R. W. Beard, "Vector field path following for
miniature air vehicles", IEEE Transactions on Robotics 23(3), 2007. Coordinates are north and east
[m] in a plane; courses are clockwise from north [rad].
"""

from __future__ import annotations

from math import atan, atan2, cos, hypot, pi, radians

from cratous.core.kernel import Vec2

EARTH_M = 6_371_000.0


def plane(latitude: float, longitude: float, of: tuple[float, float]) -> Vec2:
    """North and east [m] of a place relative to another [deg], on a flat Earth."""
    turn = (longitude - of[1] + 180.0) % 360.0 - 180.0
    north, east = radians(latitude - of[0]), radians(turn) * cos(radians(of[0]))
    return Vec2(EARTH_M * north, EARTH_M * east)


def line_course(here: Vec2, start: Vec2, to: Vec2, most_rad: float, gain_per_m: float) -> float:
    """Course onto the line from start to end: along it when on it, at most_rad to it when far away.

    gain_per_m: steepness of the transition. For a line of zero length, the course to its end.
    """
    north, east = to.x - start.x, to.y - start.y
    length = hypot(north, east)
    if not length:
        return atan2(to.y - here.y, to.x - here.x)
    off_m = (north * (here.y - start.y) - east * (here.x - start.x)) / length
    return atan2(east, north) - 2 * most_rad / pi * atan(gain_per_m * off_m)


def circle_course(here: Vec2, centre: Vec2, radius_m: float, clockwise: bool, gain: float) -> float:
    """Course onto a circle: along it when on it, towards its centre when far away."""
    north, east = here.x - centre.x, here.y - centre.y
    inwards = pi / 2 + atan(gain * (hypot(north, east) - radius_m) / radius_m)
    return atan2(east, north) + (inwards if clockwise else -inwards)


def passed(here: Vec2, before: Vec2, to: Vec2) -> bool:
    """Whether the end of a leg is abeam or behind."""
    return (before.x - to.x) * (here.x - to.x) + (before.y - to.y) * (here.y - to.y) <= 0
