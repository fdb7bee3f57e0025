"""A point of a leg that lies between the feet of the ends of an edge on the leg's own line is a point
of the edge."""

from cratous.core.geofence.passages import foot
from cratous.core.geofence.planar import on_segment, orient
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    u = c.real("u")
    c.premise(c.any_of(p.x != q.x, p.y != q.y))
    c.premise(c.use(orient, p, q, a) == 0)
    c.premise(c.use(orient, p, q, b) == 0)
    first, second = c.use(foot, p, q, a), c.use(foot, p, q, b)
    c.premise((first.num - u * first.den) * (second.num - u * second.den) <= 0)
    # the ends of the edge are the leg's points at their feet
    s, t = c.reals("s t")
    c.premise(s * first.den == first.num)
    c.premise(t * second.den == second.num)
    for parameter, end in ((s, a), (t, b)):
        at = c.define(geofence.along, p, q, parameter)
        c.step(c.all_of(at.x == end.x, at.y == end.y), "an end is at its foot")
    c.step(first.den > 0, "the leg has a length")
    c.step((s - u) * (t - u) <= 0, "between")
    m = Vec2(*c.define(geofence.along, p, q, u))
    c.show(c.use(on_segment, m, a, b))
