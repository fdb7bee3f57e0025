"""For every polygon, whatever its number of vertices, the squared distance to the boundary that the
kernel gives is the least of the squared distances to its edges."""

from typing import Any

from cratous.core.geofence.distance import Ratio, boundary_distance, edge_distance
from cratous.core.kernel import Fold
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.spec.geofence import Least, least_step


def claim(c: Claim) -> None:
    p = c.vector("p")
    c.opaque(edge_distance)
    # the squared distance of the edge in hand as a number, named by its defining equation
    here = c.real("here")

    def edge(a: Any, b: Any) -> None:
        ratio = c.use(edge_distance, p, a, b)
        c.lemma("geofence_edge_distance_is_the_least", p=p, a=a, b=b, t=0)
        c.premise(ratio.num == here * ratio.den)

    def related(states: list[Any], *_: Any) -> Any:
        ratio, least = states
        value = c.all_of(ratio.den > 0, c.same(ratio.num, least.value * ratio.den))
        nothing = c.all_of(c.same(ratio.num, 1), c.same(ratio.den, 0))
        return c.all_of(c.implies(least.any, value), c.any_of(least.any, nothing))

    def add(least: Any, *_: Any) -> Any:
        return least_step(least, here)

    def as_it_is(least: Any) -> Any:
        return least

    closed_chain(
        c,
        [(boundary_distance, Ratio(c.real("num"), c.real("den")), (p,))],
        models=[
            (
                Fold("least", "geofence.least_step", add, Least(False, 0), as_it_is),
                Least(c.boolean("any"), c.real("least")),
                (),
            )
        ],
        invariant=related,
        edge=edge,
        goal=related,
        text="the least",
    )
