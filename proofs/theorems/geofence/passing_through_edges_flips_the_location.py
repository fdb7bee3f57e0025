"""For every polygon: if a leg passes through some edges, each from strictly one side to strictly the
other and between the edge's ends, and meets no other edge, then its ends have the same location
if these edges are even in number, and different ones if they are odd; neither is the boundary."""

from typing import Any

from cratous.core.geofence.planar import (
    Seen,
    crosses_ray,
    locate,
    on_segment,
    orient,
    segments_meet,
)
from cratous.core.kernel import Fold
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.proofs.methods.sweeping import swept


def claim(c: Claim) -> None:
    p, q = c.vector("p"), c.vector("q")
    c.opaque(segments_meet, on_segment, crosses_ray, swept, orient)

    def edge(a: Any, b: Any) -> None:
        through = c.all_of(
            c.use(orient, a, b, p) * c.use(orient, a, b, q) < 0,
            c.use(orient, p, q, a) * c.use(orient, p, q, b) < 0,
        )
        missed = c.negation(c.use(segments_meet, p, q, a, b))
        c.premise(c.any_of(through, missed))
        c.lemma("geofence_crossings_telescope_along_an_edge", p=p, q=q, a=a, b=b)
        c.lemma("geofence_passing_through_an_edge_flips_its_crossing", p=p, q=q, a=a, b=b)
        c.lemma("geofence_an_end_on_an_edge_is_a_contact", p=p, q=q, a=a, b=b)
        c.lemma("geofence_an_end_beside_an_edge_is_not_on_it", p=p, q=q, a=a, b=b)

    def count(odd: Any, a: Any, b: Any, p: Any, q: Any) -> Any:
        sides = orient(a, b, p) * orient(a, b, q) < 0
        across = orient(p, q, a) * orient(p, q, b) < 0
        return odd != (sides and across)

    def invariant(states: list[Any], first: Any, last: Any) -> Any:
        from_p, from_q, odd = states
        differ = c.negation(c.same(from_p.odd, from_q.odd))
        ends = c.same(c.define(swept, first, p, q), c.define(swept, last, p, q))
        none_on = c.negation(c.any_of(from_p.on, from_q.on))
        return c.all_of(none_on, c.same(c.same(differ, ends), odd))

    def flipped(results: list[Any]) -> Any:
        at_p, at_q, odd = results
        off = c.negation(c.any_of(at_p == 0, at_q == 0))
        return c.all_of(off, c.same(c.same(at_p, at_q), c.negation(odd)))

    closed_chain(
        c,
        [
            (locate, Seen(c.boolean("p_on"), c.boolean("p_odd")), (p,)),
            (locate, Seen(c.boolean("q_on"), c.boolean("q_odd")), (q,)),
        ],
        models=[(Fold("passed", "", count, False, lambda odd: odd), c.boolean("passed"), (p, q))],
        invariant=invariant,
        edge=edge,
        goal=flipped,
        text="flips",
    )
