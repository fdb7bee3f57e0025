"""A leg that the kernel calls within a buffer of an edge, or nearer, meets it, or one of the four ends
is within the buffer of the other segment."""

from fractions import Fraction

from cratous.core.geofence.distance import edge_against, leg_nearer, leg_within
from cratous.core.geofence.planar import segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    d = c.real("d")
    c.opaque(segments_meet, edge_against)
    meet = c.use(segments_meet, p, q, a, b)
    ends = [
        c.use(edge_against, *three, d) for three in ((p, a, b), (q, a, b), (a, p, q), (b, p, q))
    ]
    nearer, within = c.use(leg_nearer, p, q, a, b, d), c.use(leg_within, p, q, a, b, d)
    c.show(c.same(nearer, c.any_of(meet, *[end < 0 for end in ends])), "nearer")
    c.show(c.same(within, c.any_of(meet, *[end <= 0 for end in ends])), "no farther")
    # the middles of two parallels one apart: what the pairs that are looked for mean
    pair = (Vec2(0, 0), Vec2(4, 0), Vec2(0, 1), Vec2(4, 1))
    for buffer, is_nearer, is_within in ((2, True, True), (1, False, True), (0, False, False)):
        at = (*pair, buffer, Fraction(1, 2), Fraction(1, 2))
        c.show(c.same(c.define(geofence.legs_nearer_at, *at), is_nearer), "an example: nearer")
        c.show(c.same(c.define(geofence.legs_within_at, *at), is_within), "an example: within")
