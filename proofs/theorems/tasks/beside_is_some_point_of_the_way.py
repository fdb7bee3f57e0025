"""Who counts as beside a way is no farther from some point of it than the width, and everybody who is counts."""

from cratous.core.geofence.distance import edge_against
from cratous.core.tasks.stations import beside
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    d, t, foot = c.reals("d t foot")
    c.premise(d >= 0)
    # foot: of the perpendicular from p, where the way has a length
    c.premise(c.define(geofence.foot_at, p, a, b, foot))
    c.opaque(edge_against, geofence.squared_distance)
    said = c.use(beside, p, a, b, d)
    c.lemma("geofence_edge_verdict_misses_no_point", p=p, a=a, b=b, d=d, t=t)
    within = c.define(geofence.within_at, p, a, b, d, t)
    c.show(c.implies(within, said), "whoever is counts")
    c.lemma("geofence_edge_verdict_has_a_witness", p=p, a=a, b=b, d=d, t=foot)
    ends = (foot - foot, foot - foot + 1, foot)
    some = [c.define(geofence.within_at, p, a, b, d, at) for at in ends]
    c.show(c.implies(said, c.any_of(*some)), "an end or the foot of the perpendicular is so near")
