"""Whoever is no farther to the side of some point of a leg than a margin, nor above or below its altitudes than a rise, is
outside of a keep-out and inside of a keep-in, for every polygon and whatever its number of vertices, where the kernels
accept the leg, higher and lower by the rise, and find that it does not come within the margin of the boundary."""

from typing import Any

from cratous.core.geofence.distance import comes_within, edge_against, leg_within
from cratous.core.geofence.planar import keep_in_leg_ok, keep_out_leg_ok
from cratous.core.geofence.regions import both_places, layer_place
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.proofs.methods.ends import PARTS, edge_of_leg, located, seen_alike
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, w = c.vector("p"), c.vector("q"), c.vector("w")
    d, rise, t = c.reals("d rise t")
    low, high, floor, ceiling, alt = c.reals("low high floor ceiling alt")
    c.premise(c.all_of(d >= 0, rise >= 0, t >= 0, t <= 1, floor <= ceiling, low <= high))
    c.premise(c.all_of(low - rise <= alt, alt <= high + rise))
    c.opaque(*PARTS, edge_against, leg_within, geofence.squared_distance)
    m = Vec2(*c.define(geofence.along, p, q, t))
    c.premise(c.define(geofence.squared_distance, m, w) <= d * d)

    def edge(a: Any, b: Any) -> None:
        c.lemma("geofence_a_part_of_a_leg_meets_no_more", p=p, q=q, a=a, b=b, t=t)
        edge_of_leg(c, p, m, a, b)
        edge_of_leg(c, m, w, a, b)
        c.lemma("geofence_a_leg_clear_of_an_edge_is_so_at_each_point", p=p, q=q, a=a, b=b, d=d, t=t)
        c.lemma(
            "geofence_a_place_near_a_clear_leg_is_beside_the_edge_too",
            p=p, q=q, w=w, a=a, b=b, d=d, t=t,
        )  # fmt: skip

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        from_p, from_m, from_w, near = state
        alike = c.all_of(
            seen_alike(c, p, m, (from_p, from_m), (first, last)),
            seen_alike(c, m, w, (from_m, from_w), (first, last)),
        )
        return c.any_of(near, alike)

    def obeyed(results: list[Any]) -> Any:
        at_p, _, at_w, near = results
        given = (at_p, near, low - rise, high + rise, floor, ceiling)
        place = c.use(both_places, at_w, c.use(layer_place, alt, floor, ceiling))
        outside = c.negation(c.define(geofence.in_closed, place))
        inside = c.define(geofence.in_open, place)
        return c.all_of(
            c.implies(c.use(keep_out_leg_ok, *given), outside),
            c.implies(c.use(keep_in_leg_ok, *given), inside),
        )

    closed_chain(
        c,
        [
            located(c, "p", p),
            located(c, "m", m),
            located(c, "w", w),
            (comes_within, c.boolean("near"), (p, q, d)),
        ],
        invariant=invariant,
        edge=edge,
        goal=obeyed,
        text="obeyed",
    )
