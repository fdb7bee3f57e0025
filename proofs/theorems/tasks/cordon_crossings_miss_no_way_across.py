"""Every straight road that is inside of a circle at some point and outside of it at another crosses it, as the
kernel says: so nobody comes from inside to outside but over a crossing, whatever roads he takes."""

from cratous.core.geofence.distance import edge_against
from cratous.core.tasks.cordon import crossings
from cratous.proofs.claim import Claim
from cratous.spec import cordon, geofence


def claim(c: Claim) -> None:
    middle, a, b = c.vector("middle"), c.vector("a"), c.vector("b")
    radius, inner, outer = c.reals("radius inner outer")
    c.premise(radius >= 0)
    c.opaque(edge_against)
    across = c.define(cordon.leads_across_at, middle, a, b, radius, inner, outer)
    said = c.use(crossings, middle, a, b, radius)
    c.lemma("geofence_edge_verdict_misses_no_point", p=middle, a=a, b=b, d=radius, t=inner)
    near = c.define(geofence.nearer_at, middle, a, b, radius, inner)
    c.step(c.implies(across, near), "its inner point is nearer than the radius")
    on_it = c.all_of(outer >= 0, outer <= 1)
    c.lemma("tasks_in_ring_holds_between_two", when=on_it, p=middle, a=a, b=b, most=radius, t=outer)
    c.show(c.implies(across, said > 0), "it crosses")
