"""Theorems on a leg's kernel, stated alike for keep-in and keep-out: what is accepted obeys at each point."""

from __future__ import annotations

from typing import Any

from cratous.core.geofence.distance import (
    boundary_against,
    comes_within,
    edge_against,
    leg_within,
)
from cratous.core.geofence.planar import (
    Seen,
    crosses_ray,
    locate,
    meets_boundary,
    on_segment,
    segments_meet,
)
from cratous.core.geofence.regions import both_places, layer_place
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.proofs.methods.sweeping import swept
from cratous.spec import geofence


def leg_is_clear(c: Claim, accepts: Any, obeys: Any) -> None:
    """A leg that the kernel `accepts` has a place that `obeys` at each of its points."""
    p, q = c.vector("p"), c.vector("q")
    p_alt, q_alt, floor, ceiling, t = c.reals("p_alt q_alt floor ceiling t")
    c.premise(t >= 0)
    c.premise(t <= 1)
    c.premise(floor <= ceiling)
    m = Vec2(*c.define(geofence.along, p, q, t))
    alt = c.define(geofence.altitude, p_alt, q_alt, t)
    low, high = c.when(p_alt <= q_alt, p_alt, q_alt), c.when(p_alt <= q_alt, q_alt, p_alt)
    c.step(c.all_of(low <= alt, alt <= high), "the altitude stays between those of the ends")
    c.opaque(segments_meet, on_segment, crosses_ray, swept)

    def edge(a: Any, b: Any) -> None:
        c.lemma("geofence_a_part_of_a_leg_meets_no_more", p=p, q=q, a=a, b=b, t=t)
        c.lemma("geofence_crossings_telescope_along_an_edge", p=p, q=m, a=a, b=b)
        c.lemma("geofence_an_end_on_an_edge_is_a_contact", p=p, q=m, a=a, b=b)

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        from_p, from_m, met = state
        differ = c.negation(c.same(from_p.odd, from_m.odd))
        ends = c.same(c.define(swept, first, p, m), c.define(swept, last, p, m))
        none_on = c.negation(c.any_of(from_p.on, from_m.on))
        return c.any_of(met, c.all_of(none_on, c.negation(c.same(differ, ends))))

    def clear(results: list[Any]) -> Any:
        at_p, at_m, met = results
        accepted = c.use(accepts, at_p, met, low, high, floor, ceiling)
        place = c.use(both_places, at_m, c.use(layer_place, alt, floor, ceiling))
        return c.implies(accepted, obeys(place))

    closed_chain(
        c,
        [
            (locate, Seen(c.boolean("p_on"), c.boolean("p_odd")), (p,)),
            (locate, Seen(c.boolean("m_on"), c.boolean("m_odd")), (m,)),
            (meets_boundary, c.boolean("met"), (p, q)),
        ],
        invariant=invariant,
        edge=edge,
        goal=clear,
        text="clear",
    )


def leg_keeps_its_buffer(c: Claim, accepts: Any, changed: Any, obeys: Any) -> None:
    """The same with a buffer; changed: the place in the zone that is narrowed or widened by it."""
    p, q = c.vector("p"), c.vector("q")
    p_alt, q_alt, floor, ceiling, t, d = c.reals("p_alt q_alt floor ceiling t d")
    c.premise(t >= 0)
    c.premise(t <= 1)
    c.premise(floor <= ceiling)
    m = Vec2(*c.define(geofence.along, p, q, t))
    alt = c.define(geofence.altitude, p_alt, q_alt, t)
    low, high = c.when(p_alt <= q_alt, p_alt, q_alt), c.when(p_alt <= q_alt, q_alt, p_alt)
    c.step(c.all_of(low <= alt, alt <= high), "the altitude stays between those of the ends")
    c.opaque(segments_meet, on_segment, crosses_ray, swept, edge_against, leg_within)

    def edge(a: Any, b: Any) -> None:
        c.lemma("geofence_a_part_of_a_leg_meets_no_more", p=p, q=q, a=a, b=b, t=t)
        c.lemma("geofence_crossings_telescope_along_an_edge", p=p, q=m, a=a, b=b)
        c.lemma("geofence_an_end_on_an_edge_is_a_contact", p=p, q=m, a=a, b=b)
        c.lemma("geofence_a_leg_clear_of_an_edge_is_so_at_each_point", p=p, q=q, a=a, b=b, d=d, t=t)
        c.lemma("geofence_edge_verdict_is_one_of_three", p=m, a=a, b=b, d=d)

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        from_p, from_m, near, least = state
        differ = c.negation(c.same(from_p.odd, from_m.odd))
        ends = c.same(c.define(swept, first, p, m), c.define(swept, last, p, m))
        none_on = c.negation(c.any_of(from_p.on, from_m.on))
        same = c.negation(c.same(differ, ends))
        verdict = c.any_of(least == -1, least == 0, least == 1)
        return c.all_of(verdict, c.any_of(near, c.all_of(none_on, same, c.same(least, 1))))

    def clear(results: list[Any]) -> Any:
        at_p, at_m, near, least = results
        accepted = c.use(accepts, at_p, near, low, high, floor, ceiling)
        buffered = c.use(changed, at_m, least)
        place = c.use(both_places, buffered, c.use(layer_place, alt, floor, ceiling))
        return c.implies(accepted, obeys(place))

    closed_chain(
        c,
        [
            (locate, Seen(c.boolean("p_on"), c.boolean("p_odd")), (p,)),
            (locate, Seen(c.boolean("m_on"), c.boolean("m_odd")), (m,)),
            (comes_within, c.boolean("near"), (p, q, d)),
            (boundary_against, c.whole("least"), (m, d)),
        ],
        invariant=invariant,
        edge=edge,
        goal=clear,
        text="clear",
    )
