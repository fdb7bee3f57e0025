"""A leg meets an edge only at the parameter of the lines' crossing or, where the two are parallel, only
on one line, and then between the feet of the edge's ends."""

from cratous.core.geofence.passages import cross, crossing, foot
from cratous.core.geofence.planar import on_segment, orient
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    t = c.real("t")
    m = Vec2(*c.define(geofence.along, p, q, t))
    on = c.use(on_segment, m, a, b)
    at = c.use(crossing, p, q, a, b)
    c.show(c.same(at.den, c.use(cross, p, q, a, b)), "no crossing of parallels")
    c.show(c.implies(on, at.num == t * at.den), "at the crossing")
    parallel = c.all_of(at.den == 0, c.any_of(p.x != q.x, p.y != q.y))
    one_line = c.all_of(c.use(orient, p, q, a) == 0, c.use(orient, p, q, b) == 0)
    c.show(c.implies(c.all_of(on, parallel), one_line), "parallel: on one line")
    first, second = c.use(foot, p, q, a), c.use(foot, p, q, b)
    low, high = first.num - t * first.den, second.num - t * second.den
    c.show(c.implies(c.all_of(on, parallel), low * high <= 0), "parallel: between the feet")
    c.show(c.same(c.define(geofence.foot_at, a, p, q, t), low == 0), "the foot is its definition")
