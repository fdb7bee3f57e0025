"""The strip between the rays from both ends of a leg, by which ray crossings telescope.

A vertex is *swept* by the leg p-q if its height lies between theirs (half-open, as for edges) and it is on the right
of the leg. Along an edge that misses the leg, the ray crossings from p and from q differ exactly if one end of the
edge is swept and the other is not. Round a closed chain every vertex is an end twice, so the differences cancel.
"""

from __future__ import annotations

from cratous.spec.geofence import Point, turn


def swept(v: Point, p: Point, q: Point) -> bool:
    """The vertex lies right of the leg p-q, at a height between its ends."""
    if p.y < v.y and v.y <= q.y:
        return turn(p, q, v) < 0
    if q.y < v.y and v.y <= p.y:
        return turn(p, q, v) > 0
    return False
