"""A leg that the keep-in kernel accepts is strictly inside the zone, off its boundary, floor and
ceiling, at each of its points, for every polygon and whatever its number of vertices."""

from typing import Any

from cratous.core.geofence.planar import (
    Seen,
    crosses_ray,
    keep_in_leg_ok,
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


def claim(c: Claim) -> None:
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
        accepted = c.use(keep_in_leg_ok, at_p, met, low, high, floor, ceiling)
        place = c.use(both_places, at_m, c.use(layer_place, alt, floor, ceiling))
        return c.implies(accepted, c.define(geofence.in_open, place))

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
