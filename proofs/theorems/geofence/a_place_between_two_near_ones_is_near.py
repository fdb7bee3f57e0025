"""Of two places that are each no farther than a buffer from a point of a leg, whatever lies straight between them is no
farther from a point of the leg either, and the kernel says so."""

from cratous.core.geofence.distance import edge_against
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    # a, b: how far the two places are off the points of the leg p-q at its shares f and g
    a, b, p, q = (c.vector(name) for name in "abpq")
    d, s, f, g = c.reals("d s f g")
    c.premise(c.all_of(d >= 0, s >= 0, s <= 1))
    one, other = (c.define(geofence.along, p, q, at) for at in (f, g))
    u, v = Vec2(one.x + a.x, one.y + a.y), Vec2(other.x + b.x, other.y + b.y)
    c.premise(c.define(geofence.within_at, u, p, q, d, f))
    c.premise(c.define(geofence.within_at, v, p, q, d, g))
    c.lemma("geofence_a_vector_between_two_short_ones_is_short", a=a, b=b, s=s, most=d * d)
    w = Vec2(*c.define(geofence.along, u, v, s))
    t = f + s * (g - f)
    c.step(c.all_of(t >= 0, t <= 1), "a point of the leg")
    c.show(c.define(geofence.within_at, w, p, q, d, t), "near")
    c.opaque(edge_against)
    c.lemma("geofence_edge_verdict_misses_no_point", p=w, a=p, b=q, d=d, t=t)
    c.show(c.use(edge_against, w, p, q, d) <= 0, "by the kernel")
