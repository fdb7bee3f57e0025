"""If any point of a leg is within a buffer of any point of an edge, or nearer, and their lines cross,
the kernel says so: moved towards the crossing, the pair reaches an end of one of the two."""

from typing import Any

from cratous.core.geofence.distance import edge_against, ends_against, leg_nearer, leg_within
from cratous.core.geofence.planar import segments_meet
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    d, s, t, s0, t0, ks, kt = c.reals("d s t s0 t0 ks kt")
    lines: dict[str, Any] = {"p": p, "q": q, "a": a, "b": b}
    # the crossing of the lines, named by its defining equations
    one, other = c.define(geofence.along, p, q, s0), c.define(geofence.along, a, b, t0)
    c.premise(one.x == other.x)
    c.premise(one.y == other.y)
    for parameter in (s, t):
        c.premise(parameter >= 0)
        c.premise(parameter <= 1)

    def reached(u0: Any, u: Any, k: Any) -> None:
        # the share of the way from the crossing at which a parameter reaches [0, 1]
        c.premise(c.implies(u0 < 0, k * (u - u0) == 0 - u0))
        c.premise(c.implies(u0 > 1, k * (u - u0) == 1 - u0))
        c.premise(c.implies(c.all_of(u0 >= 0, u0 <= 1), k == 0))

    reached(s0, s, ks)
    reached(t0, t, kt)
    k = c.when(ks <= kt, kt, ks)
    s1, t1 = s0 + k * (s - s0), t0 + k * (t - t0)
    for share in (ks, kt):
        c.step(c.all_of(share >= 0, share <= 1), "a share")
    for moved in (s1, t1):
        c.step(c.all_of(moved >= 0, moved <= 1), "still on its segment")
    crossing = c.all_of(s0 >= 0, s0 <= 1, t0 >= 0, t0 <= 1)
    at_end = c.any_of(s1 == 0, s1 == 1, t1 == 0, t1 == 1)
    c.step(c.any_of(crossing, at_end), "they meet, or an end is reached")
    c.opaque(segments_meet, edge_against, ends_against)
    c.lemma("geofence_leg_pairs_shrink_towards_a_crossing", **lines, s=s, t=t, s0=s0, t0=t0, k=k)
    c.lemma("geofence_leg_verdict_misses_no_pair_at_an_end", when=at_end, **lines, d=d, s=s1, t=t1)
    c.lemma("geofence_segments_meet_finds_every_common_point", **lines, s=s0, t=t0)
    for kernel, definition in (
        (leg_nearer, geofence.legs_nearer_at),
        (leg_within, geofence.legs_within_at),
    ):
        pair = c.define(definition, p, q, a, b, d, s, t)
        verdict = c.use(kernel, p, q, a, b, d)
        c.step(c.implies(crossing, verdict), "they meet")
        there = c.define(definition, p, q, a, b, d, s1, t1)
        c.step(c.implies(c.all_of(pair, at_end), there), "the moved pair is as near")
        c.show(c.implies(pair, verdict), kernel.__name__)
