"""An edge that lies wholly above or wholly below a point changes nothing in what is seen from it."""

from cratous.core.geofence.planar import Seen, location_step
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    seen = Seen(c.boolean("on"), c.boolean("odd"))
    above = c.all_of(a.y > p.y, b.y > p.y)
    below = c.all_of(a.y < p.y, b.y < p.y)
    same = c.same(c.use(location_step, seen, a, b, p), seen)
    c.show(c.implies(c.any_of(above, below), same))
