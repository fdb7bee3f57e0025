"""Between two neighbouring parameters of a leg's crossings, a leg's contact with an edge does not
change: its points there are all on the edge or all off it."""

from cratous.core.geofence.passages import cross, crossing, foot
from cratous.core.geofence.planar import on_segment, orient
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.crossings import feet_named, undisturbed
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    t, u, low, high = c.reals("t u low high")
    for parameter in (t, u):
        c.premise(low < parameter)
        c.premise(parameter < high)
    moves = c.any_of(p.x != q.x, p.y != q.y)
    c.opaque(crossing, cross, foot, on_segment, orient)
    at, first, second = c.use(crossing, p, q, a, b), c.use(foot, p, q, a), c.use(foot, p, q, b)
    undisturbed(c, p, q, a, b, low, high)
    here, there = (Vec2(*c.define(geofence.along, p, q, s)) for s in (t, u))
    on = c.use(on_segment, here, a, b)
    c.lemma("geofence_contact_with_an_edge_is_at_its_crossing", p=p, q=q, a=a, b=b, t=t)
    c.lemma("geofence_foot_has_the_square_of_the_leg", p=p, q=q, a=a, b=b)
    s, w = c.reals("s w")
    feet_named(c, p, q, a, b, s, w)
    c.step(c.implies(c.all_of(on, at.den != 0), False), "no contact but at the crossing")
    parallel = c.all_of(on, at.den == 0, moves)
    apart = (first.num - u * first.den) * (second.num - u * second.den) <= 0
    c.step(c.implies(parallel, apart), "one foot before, the other behind")
    c.lemma(
        "geofence_between_the_feet_is_on_the_edge",
        when=parallel,
        p=p,
        q=q,
        a=a,
        b=b,
        u=u,
        s=s,
        t=w,
    )
    still = c.all_of(p.x == q.x, p.y == q.y)
    c.congruence(on_segment, (here, a, b), (there, a, b))
    c.step(c.implies(still, c.all_of(here.x == there.x, here.y == there.y)), "no leg, one point")
    c.show(c.implies(on, c.use(on_segment, there, a, b)))
