"""The verdict on the ends of two segments is that of one of the four ends against the other segment,
and none of the four is less."""

from cratous.core.geofence.distance import edge_against, ends_against
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    d = c.real("d")
    c.opaque(edge_against)
    least = c.use(ends_against, p, q, a, b, d)
    ends = [
        c.use(edge_against, *three, d) for three in ((p, a, b), (q, a, b), (a, p, q), (b, p, q))
    ]
    for end in ends:
        c.show(least <= end, "none is less")
    c.show(c.any_of(*[least == end for end in ends]), "one of the four")
