"""On the straight way between two who are no farther from a place than a distance, nobody is farther from it."""

from cratous.core.tasks.stations import in_ring
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    most, t = c.reals("most t")
    c.premise(most >= 0)
    c.premise(c.all_of(t >= 0, t <= 1))
    both = c.all_of(*(c.use(in_ring, p, end, most - most, most) for end in (a, b)))
    first, last, apart = (
        c.define(geofence.squared_distance, *ends) for ends in ((p, a), (p, b), (a, b))
    )
    there = c.define(geofence.along, a, b, t)
    at = c.define(geofence.squared_distance, p, there)
    c.step(at == (1 - t) * first + t * last - t * (1 - t) * apart, "what it is by the ends")
    c.step(t * (1 - t) * apart >= 0, "their distance takes some of it away")
    c.step(
        c.implies(both, (1 - t) * first + t * last <= most * most), "the rest is between the ends"
    )
    c.show(c.implies(both, at <= most * most), "no farther")
