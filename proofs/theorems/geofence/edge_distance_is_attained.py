"""The squared distance that the kernel gives for an edge is that of one of its points: an end, or the
foot of the perpendicular; its denominator is positive, and 1 where an end is nearest."""

from cratous.core.geofence.distance import edge_distance
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b, t = c.vector("p"), c.vector("a"), c.vector("b"), c.real("t")
    c.premise(c.define(geofence.foot_at, p, a, b, t))
    found = c.use(edge_distance, p, a, b)
    c.show(found.den > 0, "a positive denominator")
    c.show(c.implies(c.any_of(t <= 0, t >= 1), found.den == 1), "1 at an end")

    def attained(at: object) -> object:
        there = c.define(geofence.along, a, b, at)
        squared = c.define(geofence.squared_distance, p, there)
        inside = c.all_of(at >= 0, at <= 1)  # type: ignore[operator]
        return c.all_of(inside, found.num == squared * found.den)

    c.show(c.any_of(attained(t - t), attained(t - t + 1), attained(t)), "attained")
