"""Where a leg is clear of an edge by a margin, the way from any point of the leg to a place that is no farther from that
point than the margin does not meet the edge."""

from typing import Any

from cratous.core.geofence.distance import edge_against, leg_within
from cratous.core.geofence.planar import segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.crossings import share
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, w, a, b = (c.vector(name) for name in "pqwab")
    d, t = c.reals("d t")
    c.premise(c.all_of(d >= 0, t >= 0, t <= 1))
    c.opaque(segments_meet, edge_against, leg_within, geofence.squared_distance)
    m = Vec2(*c.define(geofence.along, p, q, t))
    wx, wy, ux, uy = w.x - m.x, w.y - m.y, b.x - a.x, b.y - a.y
    det = wx * uy - wy * ux
    # the parameters that the lemma wants: of the crossing and the feet, and of their edge points
    named: dict[str, Any] = {
        "s": share(c, (a.x - m.x) * uy - (a.y - m.y) * ux, det),
        "t": share(c, (a.x - m.x) * wy - (a.y - m.y) * wx, det),
    }
    for name, end in (("f", a), ("g", b)):
        named[name] = share(c, (end.x - m.x) * wx + (end.y - m.y) * wy, wx * wx + wy * wy)
    zero = t - t
    parts = (zero, zero + 1, named["s"], named["f"], named["g"])
    for name, part in zip("ijkor", parts, strict=True):
        at = c.define(geofence.along, m, w, part)
        named[name] = share(c, (at.x - a.x) * ux + (at.y - a.y) * uy, ux * ux + uy * uy)
    c.lemma("geofence_contact_puts_the_boundary_as_near", p=m, m=w, a=a, b=b, d=d, **named)
    c.lemma("geofence_a_leg_clear_of_an_edge_is_so_at_each_point", p=p, q=q, a=a, b=b, d=d, t=t)
    near = c.define(geofence.squared_distance, m, w) <= d * d
    meets, within = c.use(segments_meet, m, w, a, b), c.use(leg_within, p, q, a, b, d)
    c.show(c.implies(c.all_of(near, meets), within))
