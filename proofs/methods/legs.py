"""Theorems on the kernel that checks a leg, for keep-in and keep-out: an accepted leg obeys at each of its points."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.geofence.distance import (
    boundary_against,
    comes_within,
    edge_against,
    leg_within,
)
from cratous.core.geofence.planar import meets_boundary
from cratous.core.geofence.regions import both_places, layer_place
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.proofs.methods.ends import PARTS, edge_of_leg, located, seen_alike
from cratous.spec import geofence


class Leg(NamedTuple):
    """A leg p-q, a point m of it at the fraction t, altitudes (least, at m, greatest), and a layer's two limits."""

    p: Vec2
    q: Vec2
    m: Vec2
    t: Any
    altitudes: tuple[Any, Any, Any]
    layer: tuple[Any, Any]


def any_leg(c: Claim) -> Leg:
    """An arbitrary leg from `p`, `p_alt` to `q`, `q_alt`, fraction `t` of it, and layer `floor` to `ceiling`."""
    p, q = c.vector("p"), c.vector("q")
    p_alt, q_alt, floor, ceiling, t = c.reals("p_alt q_alt floor ceiling t")
    c.premise(t >= 0)
    c.premise(t <= 1)
    c.premise(floor <= ceiling)
    m = Vec2(*c.define(geofence.along, p, q, t))
    alt = c.define(geofence.altitude, p_alt, q_alt, t)
    low, high = c.when(p_alt <= q_alt, p_alt, q_alt), c.when(p_alt <= q_alt, q_alt, p_alt)
    c.step(c.all_of(low <= alt, alt <= high), "the altitude stays between those of the ends")
    return Leg(p, q, m, t, (low, alt, high), (floor, ceiling))


def leg_is_clear(c: Claim, accepts: Any, obeys: Any) -> None:
    """If the kernel `accepts` a leg, the place at each of its points `obeys`."""
    p, q, m, t, (low, alt, high), (floor, ceiling) = any_leg(c)
    c.opaque(*PARTS)

    def edge(a: Any, b: Any) -> None:
        c.lemma("geofence_a_part_of_a_leg_meets_no_more", p=p, q=q, a=a, b=b, t=t)
        edge_of_leg(c, p, m, a, b)

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        from_p, from_m, met = state
        return c.any_of(met, seen_alike(c, p, m, (from_p, from_m), (first, last)))

    def clear(results: list[Any]) -> Any:
        at_p, at_m, met = results
        accepted = c.use(accepts, at_p, met, low, high, floor, ceiling)
        place = c.use(both_places, at_m, c.use(layer_place, alt, floor, ceiling))
        return c.implies(accepted, obeys(place))

    closed_chain(
        c,
        [
            located(c, "p", p),
            located(c, "m", m),
            (meets_boundary, c.boolean("met"), (p, q)),
        ],
        invariant=invariant,
        edge=edge,
        goal=clear,
        text="clear",
    )


def leg_keeps_its_buffer(c: Claim, accepts: Any, changed: Any, obeys: Any) -> None:
    """The same with a buffer; changed: the place in the zone narrowed or widened by it."""
    p, q, m, t, (low, alt, high), (floor, ceiling) = any_leg(c)
    d = c.real("d")
    c.opaque(*PARTS, edge_against, leg_within)

    def edge(a: Any, b: Any) -> None:
        c.lemma("geofence_a_part_of_a_leg_meets_no_more", p=p, q=q, a=a, b=b, t=t)
        edge_of_leg(c, p, m, a, b)
        c.lemma("geofence_a_leg_clear_of_an_edge_is_so_at_each_point", p=p, q=q, a=a, b=b, d=d, t=t)
        c.lemma("geofence_edge_verdict_is_one_of_three", p=m, a=a, b=b, d=d)

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        from_p, from_m, near, least = state
        apart = seen_alike(c, p, m, (from_p, from_m), (first, last))
        verdict = c.any_of(least == -1, least == 0, least == 1)
        return c.all_of(verdict, c.any_of(near, c.all_of(apart, c.same(least, 1))))

    def clear(results: list[Any]) -> Any:
        at_p, at_m, near, least = results
        accepted = c.use(accepts, at_p, near, low, high, floor, ceiling)
        buffered = c.use(changed, at_m, least)
        place = c.use(both_places, buffered, c.use(layer_place, alt, floor, ceiling))
        return c.implies(accepted, obeys(place))

    closed_chain(
        c,
        [
            located(c, "p", p),
            located(c, "m", m),
            (comes_within, c.boolean("near"), (p, q, d)),
            (boundary_against, c.whole("least"), (m, d)),
        ],
        invariant=invariant,
        edge=edge,
        goal=clear,
        text="clear",
    )
