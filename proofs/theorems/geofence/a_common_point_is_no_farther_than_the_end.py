"""A point that a leg and an edge have in common is no farther from the leg's first point than the
leg's second point is."""

from cratous.core.geofence.distance import apart_squared
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, m, a, b = c.vector("p"), c.vector("m"), c.vector("a"), c.vector("b")
    d, v, w = c.reals("d v w")
    c.premise(d >= 0)
    common = c.define(geofence.common_point, p, m, a, b, v, w)
    squared = c.define(geofence.squared_distance, p, m)
    c.show(c.same(c.use(apart_squared, p, m), squared), "the kernel's square is the definition's")
    at = c.define(geofence.along, p, m, v)
    there = c.define(geofence.along, a, b, w)
    c.step(c.same(c.define(geofence.squared_distance, p, at), v * v * squared), "it scales")
    c.step(c.implies(common, v * v <= 1), "at most once")
    c.step(squared >= 0, "a square")
    c.step(c.implies(common, v * v * squared <= squared), "no farther")
    moved = c.define(geofence.squared_distance, p, there)
    c.step(c.implies(common, moved <= squared), "the same point")
    within = c.define(geofence.within_at, p, a, b, d, w)
    nearer = c.define(geofence.nearer_at, p, a, b, d, w)
    c.show(c.implies(c.all_of(common, squared <= d * d), within), "no farther")
    c.show(c.implies(c.all_of(common, squared < d * d), nearer), "nearer")
