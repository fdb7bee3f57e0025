"""A leg and an edge whose bounding boxes have no point in common do not meet."""

from cratous.core.geofence.planar import segments_meet
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    meet = c.use(segments_meet, p, q, a, b)

    def beyond(one: object, other: object) -> object:
        # every coordinate of the one is greater than every one of the other
        return c.all_of(*[x > y for x in one for y in other])  # type: ignore[attr-defined]

    x, y = ((p.x, q.x), (a.x, b.x)), ((p.y, q.y), (a.y, b.y))
    apart = c.any_of(*[beyond(*pair) for u, v in (x, y) for pair in ((u, v), (v, u))])
    c.show(c.implies(apart, c.negation(meet)))
