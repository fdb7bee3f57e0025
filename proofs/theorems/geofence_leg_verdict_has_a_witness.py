"""A leg that the kernel calls within a buffer of an edge, or nearer, meets it, or one of the four ends
is within the buffer of the other segment."""

from cratous.core.geofence_distance import edge_against, leg_nearer, leg_within
from cratous.core.polygon import segments_meet
from cratous.proofs.claim import Claim


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
