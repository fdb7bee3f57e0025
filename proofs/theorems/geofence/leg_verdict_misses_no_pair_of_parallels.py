"""If any point of a leg is within a buffer of any point of an edge, or nearer, and the two are parallel
or one of them is a point, the kernel says so: moved along both lines at once, the pair keeps its
distance until it reaches an end of one of the two."""

from typing import Any

from cratous.core.geofence.distance import edge_against, ends_against, leg_nearer, leg_within
from cratous.core.geofence.passages import cross
from cratous.core.geofence.planar import segments_meet
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    d, s, t, ks, kt = c.reals("d s t ks kt")
    wx, wy, ux, uy = q.x - p.x, q.y - p.y, b.x - a.x, b.y - a.y
    c.premise(c.use(cross, p, q, a, b) == 0)
    for parameter in (s, t):
        c.premise(parameter >= 0)
        c.premise(parameter <= 1)
    # the common direction: ds of the leg is dt of the edge; where one is a point, the other moves
    leg, edge = wx * wx + wy * wy, ux * ux + uy * uy
    both = wx * ux + wy * uy
    ds, dt = (
        c.when(leg == 0, 1, c.when(edge == 0, 0, both)),
        c.when(leg == 0, 0, c.when(edge == 0, 1, leg)),
    )
    c.step(c.all_of(ds * wx == dt * ux, ds * wy == dt * uy), "the same way on both")

    def reached(v: Any, dv: Any, k: Any) -> None:
        # how far it is along that direction until a parameter is at an end
        c.premise(c.implies(dv > 0, k * dv == 1 - v))
        c.premise(c.implies(dv < 0, k * dv == 0 - v))

    reached(s, ds, ks)
    reached(t, dt, kt)
    k = c.when(ds == 0, kt, c.when(dt == 0, ks, c.when(ks <= kt, ks, kt)))
    s1, t1 = s + k * ds, t + k * dt
    c.step(k >= 0, "onward")
    for moved in (s1, t1):
        c.step(c.all_of(moved >= 0, moved <= 1), "still on its segment")
    at_end = c.any_of(s1 == 0, s1 == 1, t1 == 0, t1 == 1)
    c.step(at_end, "an end is reached")
    one, other = c.define(geofence.along, p, q, s), c.define(geofence.along, a, b, t)
    here, there = c.define(geofence.along, p, q, s1), c.define(geofence.along, a, b, t1)
    c.step(there.x - here.x == other.x - one.x, "as far in x")
    c.step(there.y - here.y == other.y - one.y, "as far in y")
    before = c.define(geofence.squared_distance, one, other)
    after = c.define(geofence.squared_distance, here, there)
    dx, dy = c.reals("dx dy")
    c.premise(dx == other.x - one.x)
    c.premise(dy == other.y - one.y)
    for square in (before, after):
        c.step(square == dx * dx + dy * dy, "the same square")
    c.opaque(segments_meet, edge_against, ends_against)
    lines: dict[str, Any] = {"p": p, "q": q, "a": a, "b": b}
    c.lemma("geofence_leg_verdict_misses_no_pair_at_an_end", **lines, d=d, s=s1, t=t1)
    for kernel, definition in (
        (leg_nearer, geofence.legs_nearer_at),
        (leg_within, geofence.legs_within_at),
    ):
        pair = c.define(definition, p, q, a, b, d, s, t)
        moved_pair = c.define(definition, p, q, a, b, d, s1, t1)
        c.step(c.implies(pair, moved_pair), "the moved pair is as near")
        c.show(c.implies(pair, c.use(kernel, p, q, a, b, d)), kernel.__name__)
