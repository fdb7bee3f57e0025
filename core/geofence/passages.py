"""Where a straight leg changes its place: parameters of crossings, as ratios. No division.

Definitions: `spec.geofence`. The leg p-q is p + t (q - p). An edge that is not parallel to it can only be met at one
t; a parallel one on the same line from the foot of one of its ends to that of the other; a floor or ceiling at one t.
Between two neighbouring parameters of these the place does not change (proved), so that finitely many points
determine the places of a leg.
"""

from __future__ import annotations

from cratous.core.geofence.distance import Ratio, ahead, apart_squared
from cratous.core.kernel import Vec2, kernel


@kernel(supports="crossing")
def cross(p: Vec2, q: Vec2, a: Vec2, b: Vec2) -> float:
    """The determinant of the directions of p-q and a-b; 0 iff parallel."""
    return (q.x - p.x) * (b.y - a.y) - (q.y - p.y) * (b.x - a.x)


@kernel(implements="geofence.lines_meet_at")
def crossing(p: Vec2, q: Vec2, a: Vec2, b: Vec2) -> Ratio:
    """The parameter at which the line p-q crosses the line a-b; den = 0 if they are parallel.

    den may be negative.
    """
    num = (a.x - p.x) * (b.y - a.y) - (a.y - p.y) * (b.x - a.x)
    return Ratio(num, cross(p, q, a, b))


@kernel(implements="geofence.foot_at")
def foot(p: Vec2, q: Vec2, m: Vec2) -> Ratio:
    """The parameter of the foot of m on the line p-q; den = 0 if p is q."""
    return Ratio(ahead(m, p, q), apart_squared(p, q))


@kernel(implements="geofence.altitude")
def level(p_alt_m: float, q_alt_m: float, alt_m: float) -> Ratio:
    """The parameter at which a leg is at an altitude; den = 0 if it is level, or negative."""
    return Ratio(alt_m - p_alt_m, q_alt_m - p_alt_m)
