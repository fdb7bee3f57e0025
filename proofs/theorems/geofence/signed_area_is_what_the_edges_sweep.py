"""Twice the signed area of a polygon, whatever its number of vertices, is the sum of what its edges sweep
between themselves and the y axis: positive if it runs from +x towards +y around its inside (Green)."""

from typing import Any

from cratous.core.geofence.planar import twice_area
from cratous.core.kernel import Fold
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.spec.geofence import swept, turn


def add(sum_: Any, a: Any, b: Any) -> Any:
    return sum_ + swept(a, b)


def as_it_is(sum_: Any) -> Any:
    return sum_


def claim(c: Claim) -> None:
    p = c.vector("p")

    def invariant(states: list[Any], first: Any, last: Any) -> Any:
        # the chain that goes back to its first vertex has the same area from both
        area, sum_ = states
        back = c.define(turn, p, last, first), c.define(swept, last, first)
        return c.same(area + back[0], sum_ + back[1])

    closed_chain(
        c,
        [(twice_area, c.real("area"), (p,))],
        models=[(Fold("sum", "geofence.swept", add, 0, as_it_is), c.real("sum"), ())],
        invariant=invariant,
        edge=lambda a, b: None,
        goal=lambda results: c.same(*results),
        text="the same area",
    )
