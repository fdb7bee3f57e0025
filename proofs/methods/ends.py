"""For theorems on legs: where two points lie relative to a chain, and whether the leg between them meets it."""

from __future__ import annotations

from typing import Any

from cratous.core.geofence.planar import Seen, crosses_ray, locate, on_segment, segments_meet
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import Run
from cratous.proofs.methods.sweeping import swept

PARTS = (segments_meet, on_segment, crosses_ray, swept)
"""The functions evaluated for each edge; theorems on whole chains know them through lemmas alone."""


def located(c: Claim, name: str, point: Any) -> Run:
    """The fold that locates a point, from an arbitrary accumulator `name_on`, `name_odd`."""
    return locate, Seen(c.boolean(f"{name}_on"), c.boolean(f"{name}_odd")), (point,)


def edge_of_leg(c: Claim, p: Any, q: Any, a: Any, b: Any) -> None:
    """Use the lemmas on one edge a-b and the leg p-q: crossings telescope, and an end on the edge is a contact."""
    c.lemma("geofence_crossings_telescope_along_an_edge", p=p, q=q, a=a, b=b)
    c.lemma("geofence_an_end_on_an_edge_is_a_contact", p=p, q=q, a=a, b=b)


def seen_alike(c: Claim, p: Any, q: Any, seen: tuple[Any, Any], chain: tuple[Any, Any]) -> Any:
    """Invariant: neither end is on an edge so far, and their ray crossings differ iff one end of the chain is swept.

    seen: the accumulators of p and of q; chain: its first vertex and the current one.
    """
    from_p, from_q = seen
    first, last = chain
    differ = c.negation(c.same(from_p.odd, from_q.odd))
    ends = c.same(c.define(swept, first, p, q), c.define(swept, last, p, q))
    none_on = c.negation(c.any_of(from_p.on, from_q.on))
    return c.all_of(none_on, c.negation(c.same(differ, ends)))
