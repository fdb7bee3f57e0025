"""Points seen from a polygon that moves straight at a constant velocity: in its frame it stands still. No division.

Definitions: `spec.geofence`. A leg flown from one instant to another is a straight leg in that frame too, and at each
instant it has there the place that it has in the moving polygon (proved), so the kernels for standing polygons decide.
"""

from __future__ import annotations

from cratous.core.geofence.planar import orient
from cratous.core.kernel import Vec2, kernel


@kernel(implements="geofence.moved")
def seen_from(p: Vec2, velocity: Vec2, t_s: float) -> Vec2:
    """A point in the frame of a polygon that has moved at velocity [unit of p / s] for t_s seconds."""
    return Vec2(p.x - t_s * velocity.x, p.y - t_s * velocity.y)


@kernel(implements="geofence.right_at")
def stays_left(a: Vec2, b: Vec2, m: Vec2, velocity: Vec2, begin_s: float, end_s: float) -> bool:
    """True iff a moving vertex is left of the line a-b, or on it, at every instant from begin_s to end_s [s].

    m: the vertex at time 0; begin_s <= end_s.
    """
    first = Vec2(m.x + begin_s * velocity.x, m.y + begin_s * velocity.y)
    last = Vec2(m.x + end_s * velocity.x, m.y + end_s * velocity.y)
    return orient(a, b, first) >= 0 and orient(a, b, last) >= 0
