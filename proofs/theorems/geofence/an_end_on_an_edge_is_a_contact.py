"""A leg of which either end is a point of an edge meets that edge."""

from cratous.core.geofence.planar import on_segment, segments_meet
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    meets = c.use(segments_meet, p, q, a, b)
    for name, end in (("first", p), ("second", q)):
        c.show(c.implies(c.use(on_segment, end, a, b), meets), f"the {name} end")
