"""For every polygon, whatever its number of vertices and their order, both ends of a leg that does
not meet the boundary have the same location, which is not the boundary."""

from typing import Any

from cratous.core.geofence.planar import (
    Seen,
    crosses_ray,
    locate,
    meets_boundary,
    on_segment,
    segments_meet,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.proofs.methods.sweeping import swept


def claim(c: Claim) -> None:
    p, q = c.vector("p"), c.vector("q")
    c.opaque(segments_meet, on_segment, crosses_ray, swept)

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        from_p, from_q, met = state
        differ = c.negation(c.same(from_p.odd, from_q.odd))
        ends = c.same(c.define(swept, first, p, q), c.define(swept, last, p, q))
        none_on = c.negation(c.any_of(from_p.on, from_q.on))
        return c.any_of(met, c.all_of(none_on, c.negation(c.same(differ, ends))))

    def edge(a: Any, b: Any) -> None:
        c.lemma("geofence_crossings_telescope_along_an_edge", p=p, q=q, a=a, b=b)
        c.lemma("geofence_an_end_on_an_edge_is_a_contact", p=p, q=q, a=a, b=b)

    def same(results: list[Any]) -> Any:
        at_p, at_q, met = results
        return c.any_of(met, c.all_of(at_p == at_q, c.negation(at_p == 0)))

    closed_chain(
        c,
        [
            (locate, Seen(c.boolean("p_on"), c.boolean("p_odd")), (p,)),
            (locate, Seen(c.boolean("q_on"), c.boolean("q_odd")), (q,)),
            (meets_boundary, c.boolean("met"), (p, q)),
        ],
        invariant=invariant,
        edge=edge,
        goal=same,
        text="same location",
    )
