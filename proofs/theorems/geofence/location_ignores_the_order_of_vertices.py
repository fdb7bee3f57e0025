"""The location of a point does not depend on the order in which the vertices are listed, clockwise
or not, nor on the vertex with which the list begins."""

from cratous.core.geofence.planar import Seen, crosses_ray, location_step, on_segment
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    p, a, b, d, e = (c.vector(name) for name in ("p", "a", "b", "d", "e"))
    c.show(c.same(c.use(on_segment, p, a, b), c.use(on_segment, p, b, a)), "on an edge, reversed")
    c.show(c.same(c.use(crosses_ray, p, a, b), c.use(crosses_ray, p, b, a)), "a crossing, reversed")
    c.opaque(on_segment, crosses_ray)
    # any order of the edges is reached by exchanging neighbours
    seen = Seen(c.boolean("on"), c.boolean("odd"))
    one = c.use(location_step, c.use(location_step, seen, a, b, p), d, e, p)
    other = c.use(location_step, c.use(location_step, seen, d, e, p), a, b, p)
    c.show(c.same(one, other), "two edges, exchanged")
