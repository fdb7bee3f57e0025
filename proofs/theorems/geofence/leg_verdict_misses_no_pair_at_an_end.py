"""If a pair of points of a leg and an edge, one of them an end of its segment, is within a buffer of
each other, or nearer, the kernel says so."""

from cratous.core.geofence.distance import edge_against, ends_against, leg_nearer, leg_within
from cratous.core.geofence.planar import segments_meet
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    d, s, t = c.reals("d s t")
    c.opaque(segments_meet, edge_against, ends_against)
    c.premise(c.any_of(s == 0, s == 1, t == 0, t == 1))
    nearer = c.define(geofence.legs_nearer_at, p, q, a, b, d, s, t)
    within = c.define(geofence.legs_within_at, p, q, a, b, d, s, t)
    for case, end, one, other, at in (
        (s == 0, p, a, b, t),
        (s == 1, q, a, b, t),
        (t == 0, a, p, q, s),
        (t == 1, b, p, q, s),
    ):
        c.lemma("geofence_edge_verdict_misses_no_point", p=end, a=one, b=other, d=d, t=at)
        for pair, definition in ((nearer, geofence.nearer_at), (within, geofence.within_at)):
            alone = c.define(definition, end, one, other, d, at)
            c.step(c.implies(c.all_of(case, pair), alone), "the same pair")
    c.lemma("geofence_ends_verdict_is_the_least_of_four", p=p, q=q, a=a, b=b, d=d)
    c.show(c.implies(nearer, c.use(leg_nearer, p, q, a, b, d)), "nearer")
    c.show(c.implies(within, c.use(leg_within, p, q, a, b, d)), "no farther")
