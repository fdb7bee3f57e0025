"""Whether a vehicle is on its path, which waypoint lies ahead, and who flies straight.

These determine which path is predicted and which waypoint an avoiding vehicle flies to. Free of divisions and roots.
Definitions: `spec.avoidance.way_ahead`.
"""

from cratous.core.geofence.distance import apart_squared
from cratous.core.kernel import Vec2, kernel


@kernel(implements="avoidance.way_ahead.near_line_at", nonnegative=("width_m",))
def near_line(p: Vec2, a: Vec2, b: Vec2, width_m: float) -> bool:
    """True iff p is at most width_m [m], >= 0, from the straight line through a and b; from a, if
    both are one point.
    """
    squared = apart_squared(a, b)
    if squared <= 0:
        return apart_squared(p, a) <= width_m * width_m
    cross = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)
    return cross * cross <= width_m * width_m * squared


@kernel(implements="avoidance.way_ahead.there_at", nonnegative=("speed_m_s", "within_s"))
def there_within(p: Vec2, goal: Vec2, speed_m_s: float, within_s: float) -> bool:
    """True iff the goal can be reached from p in less than within_s [s], >= 0.

    speed_m_s: [m/s], > 0.
    """
    most = speed_m_s * within_s
    return apart_squared(p, goal) < most * most


@kernel(implements="avoidance.way_ahead.makes_for_at", nonnegative=("radius_m",))
def makes_for(p: Vec2, goal: Vec2, beyond: Vec2, radius_m: float) -> bool:
    """True iff the goal can be flown to from p: farther than three turn radii and not passed abeam.

    beyond: the waypoint that follows the goal; radius_m: of a turn [m], >= 0.
    """
    forward = (goal.x - p.x) * (beyond.x - goal.x) + (goal.y - p.y) * (beyond.y - goal.y)
    return forward > 0 and apart_squared(p, goal) > 9 * radius_m * radius_m


@kernel(implements="avoidance.way_ahead.turns", nonnegative=("rate_rad_s", "dt_s"))
def turns(turn_rad: float, rate_rad_s: float, dt_s: float) -> bool:
    """True iff a course that has turned by turn_rad in dt_s [s], > 0, turns faster than the rate."""
    return abs(turn_rad) > rate_rad_s * dt_s
