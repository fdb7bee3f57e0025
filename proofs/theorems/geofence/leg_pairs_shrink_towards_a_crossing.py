"""A pair of points of two segments, moved towards the crossing of their lines until one of them is an
end of its segment, comes no farther apart."""

from cratous.core.geofence.distance import apart_squared
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    s, t, s0, t0, k = c.reals("s t s0 t0 k")
    c.premise(k >= 0)
    c.premise(k <= 1)
    one, other = c.define(geofence.along, p, q, s0), c.define(geofence.along, a, b, t0)
    c.premise(one.x == other.x)
    c.premise(one.y == other.y)
    pair = [c.define(geofence.along, p, q, s), c.define(geofence.along, a, b, t)]
    moved = [
        c.define(geofence.along, p, q, s0 + k * (s - s0)),
        c.define(geofence.along, a, b, t0 + k * (t - t0)),
    ]
    before, after = c.use(apart_squared, *pair), c.use(apart_squared, *moved)
    c.step(moved[1].x - moved[0].x == k * (pair[1].x - pair[0].x), "x shrinks")
    c.step(moved[1].y - moved[0].y == k * (pair[1].y - pair[0].y), "y shrinks")
    c.step(after == k * k * before, "the square shrinks")
    c.step(before >= 0, "a square")
    c.show(after <= before)
