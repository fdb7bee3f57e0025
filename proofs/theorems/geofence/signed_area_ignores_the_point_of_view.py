"""Twice the signed area of a polygon, whatever its number of vertices, is the same from whatever point
its triangles are drawn."""

from typing import Any

from cratous.core.geofence.planar import twice_area
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.spec.geofence import turn


def claim(c: Claim) -> None:
    p, q = c.vector("p"), c.vector("q")

    def invariant(states: list[Any], first: Any, last: Any) -> Any:
        # the chain that goes back to its first vertex has the same area from both
        back = [c.define(turn, point, last, first) for point in (p, q)]
        return c.same(states[0] + back[0], states[1] + back[1])

    closed_chain(
        c,
        [(twice_area, c.real("from_p"), (p,)), (twice_area, c.real("from_q"), (q,))],
        invariant=invariant,
        edge=lambda a, b: None,
        goal=lambda results: c.same(*results),
        text="same area",
    )
