"""For every polygon, whatever its number of vertices and their order, both ends of a leg that does
not meet the boundary have the same location, which is not the boundary."""

from typing import Any

from cratous.core.geofence.planar import meets_boundary
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.proofs.methods.ends import PARTS, edge_of_leg, located, seen_alike


def claim(c: Claim) -> None:
    p, q = c.vector("p"), c.vector("q")
    c.opaque(*PARTS)

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        from_p, from_q, met = state
        return c.any_of(met, seen_alike(c, p, q, (from_p, from_q), (first, last)))

    def edge(a: Any, b: Any) -> None:
        edge_of_leg(c, p, q, a, b)

    def same(results: list[Any]) -> Any:
        at_p, at_q, met = results
        return c.any_of(met, c.all_of(at_p == at_q, c.negation(at_p == 0)))

    closed_chain(
        c,
        [
            located(c, "p", p),
            located(c, "q", q),
            (meets_boundary, c.boolean("met"), (p, q)),
        ],
        invariant=invariant,
        edge=edge,
        goal=same,
        text="same location",
    )
