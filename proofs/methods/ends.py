"""Where two points lie of a chain, and whether the leg between them meets it: what theorems on legs share."""

from __future__ import annotations

from typing import Any

from cratous.core.geofence.planar import Seen, crosses_ray, locate, on_segment, segments_meet
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import Run
from cratous.proofs.methods.sweeping import swept

PARTS = (segments_meet, on_segment, crosses_ray, swept)
"""What an edge is asked; theorems on whole chains know it by lemmas alone."""


def located(c: Claim, name: str, point: Any) -> Run:
    """The fold that locates a point, from any accumulator `name_on`, `name_odd`."""
    return locate, Seen(c.boolean(f"{name}_on"), c.boolean(f"{name}_odd")), (point,)


def edge_of_leg(c: Claim, p: Any, q: Any, a: Any, b: Any) -> None:
    """Use what is known of one edge a-b and the leg p-q: crossings telescope, an end on it is a contact."""
    c.lemma("geofence_crossings_telescope_along_an_edge", p=p, q=q, a=a, b=b)
    c.lemma("geofence_an_end_on_an_edge_is_a_contact", p=p, q=q, a=a, b=b)


def seen_alike(c: Claim, p: Any, q: Any, seen: tuple[Any, Any], chain: tuple[Any, Any]) -> Any:
    """Neither end is on an edge so far, and the ray crossings differ as the chain's ends are swept.

    seen: the accumulators of p and of q; chain: its first vertex and the present one.
    """
    from_p, from_q = seen
    first, last = chain
    differ = c.negation(c.same(from_p.odd, from_q.odd))
    ends = c.same(c.define(swept, first, p, q), c.define(swept, last, p, q))
    none_on = c.negation(c.any_of(from_p.on, from_q.on))
    return c.all_of(none_on, c.negation(c.same(differ, ends)))
