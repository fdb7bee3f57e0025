"""A leg that has no point in common with a box around all vertices of a polygon begins outside the
polygon and meets none of its edges."""

from typing import Any

from cratous.core.geofence.planar import Seen, locate, meets_boundary
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain


def claim(c: Claim) -> None:
    p, q = c.vector("p"), c.vector("q")
    south, north, west, east = c.reals("south north west east")

    def boxed(v: Any) -> Any:
        return c.all_of(v.x >= south, v.x <= north, v.y >= west, v.y <= east)

    def beside(low: Any, high: Any, one: Any, other: Any) -> Any:
        return c.any_of(c.all_of(one < low, other < low), c.all_of(one > high, other > high))

    c.premise(c.any_of(beside(south, north, p.x, q.x), beside(west, east, p.y, q.y)))

    def above(v: Any) -> Any:
        return v.y > p.y

    # where the ray passes below or above the box, or right of it, no edge is crossed; from a point
    # left of it, the crossings are those of the edges with the height of the point
    def invariant(states: list[Any], first: Any, last: Any) -> Any:
        seen, met = states
        telescoped = c.same(c.same(above(first), above(last)), c.negation(seen.odd))
        left = p.x < south
        parity = c.any_of(
            c.all_of(left, telescoped), c.all_of(c.negation(left), c.negation(seen.odd))
        )
        within = c.all_of(boxed(first), boxed(last))
        return c.all_of(within, c.negation(seen.on), c.negation(met), parity)

    def edge(a: Any, b: Any) -> None:
        c.premise(boxed(b))

    def outside(results: list[Any]) -> Any:
        where, met = results
        return c.all_of(where == -1, c.negation(met))

    closed_chain(
        c,
        [
            (locate, Seen(c.boolean("on"), c.boolean("odd")), (p,)),
            (meets_boundary, c.boolean("met"), (p, q)),
        ],
        invariant=invariant,
        begin=lambda first: c.premise(boxed(first)),
        edge=edge,
        goal=outside,
        text="outside",
    )
