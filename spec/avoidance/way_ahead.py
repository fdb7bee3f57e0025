"""When a vehicle is on a path, has a waypoint ahead, and flies straight.

Some definitions take an instant or a distance flown as their last argument; the docstring states how it is
quantified. They decide which path is predicted and which waypoint an avoiding vehicle flies to; conflicts on that
path are decided by the definitions of well clear and of zones. Metres, seconds, radians.
"""

from __future__ import annotations

from cratous.spec.geofence import Point, along, squared_distance

RADII = 3
"""A waypoint nearer than this many turn radii may be impossible to reach by a turn."""


def near_line_at(p: Point, a: Point, b: Point, width: float, t: float) -> bool:
    """A point of the straight line through a and b is no farther from p than the width. EXISTS t."""
    return squared_distance(p, along(a, b, t)) <= width * width


def there_at(p: Point, goal: Point, speed: float, within: float, t: float) -> bool:
    """Flown straight towards the goal, it has been reached at the instant t, sooner than `within`. EXISTS t. Premise:
    speed > 0.
    """
    flown = speed * t
    return t >= 0 and t < within and flown * flown >= squared_distance(p, goal)


def ahead_at(p: Point, goal: Point, beyond: Point, s: float) -> bool:
    """Flying from p some distance in the direction of the leg from the goal to `beyond` brings one nearer to the
    goal: it has not been passed abeam. EXISTS s, in lengths of that leg.
    """
    there = Point(p.x + s * (beyond.x - goal.x), p.y + s * (beyond.y - goal.y))
    return s > 0 and squared_distance(there, goal) < squared_distance(p, goal)


def makes_for_at(p: Point, goal: Point, beyond: Point, radius: float, s: float) -> bool:
    """The goal can be flown to: far enough away to turn to it, and ahead. EXISTS s. Premise: radius >= 0."""
    near = RADII * radius
    return not squared_distance(p, goal) <= near * near and ahead_at(p, goal, beyond, s)


def turns(turn: float, rate: float, dt: float) -> bool:
    """The course has turned faster than the rate, in either direction. Premise: dt > 0."""
    return turn / dt > rate or turn / dt < -rate
