"""A road that is said to cross a circle once has one end inside and the other outside; one that is said to cross it
twice has both ends outside and a point inside; and it is never said to cross otherwise."""

from cratous.core.geofence.distance import apart_squared, edge_against
from cratous.core.tasks.cordon import crossings
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    middle, a, b = c.vector("middle"), c.vector("a"), c.vector("b")
    radius, foot = c.reals("radius foot")
    c.premise(radius >= 0)
    # foot: of the perpendicular from the middle, where the road has a length
    c.premise(c.define(geofence.foot_at, middle, a, b, foot))
    c.opaque(edge_against, apart_squared, geofence.squared_distance)
    said = c.use(crossings, middle, a, b, radius)
    inside = [c.use(apart_squared, middle, end) <= radius * radius for end in (a, b)]
    one = c.any_of(*inside), c.negation(c.all_of(*inside))
    c.show(c.same(said == 1, c.all_of(*one)), "once: one end inside")
    c.lemma("geofence_edge_verdict_has_a_witness", p=middle, a=a, b=b, d=radius, t=foot)
    places = (foot - foot, foot - foot + 1, foot)
    nearer = [c.define(geofence.nearer_at, middle, a, b, radius, at) for at in places]
    outside = [c.negation(end) for end in inside]
    c.show(c.implies(said == 2, c.all_of(*outside, c.any_of(*nearer))), "twice: a point inside")
    c.show(c.any_of(said == 0, said == 1, said == 2), "no other number")
