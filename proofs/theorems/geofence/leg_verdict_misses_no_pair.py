"""If any point of a leg is within a buffer of any point of an edge, or nearer, the kernel says so, for
every leg and edge, parallel or not, also of length zero."""

from typing import Any

from cratous.core.geofence.distance import edge_against, leg_nearer, leg_within
from cratous.core.geofence.passages import cross
from cratous.core.geofence.planar import segments_meet
from cratous.proofs.claim import Claim
from cratous.proofs.methods.crossings import share
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    d, s, t = c.reals("d s t")
    for parameter in (s, t):
        c.premise(parameter >= 0)
        c.premise(parameter <= 1)
    c.opaque(segments_meet, edge_against, leg_nearer, leg_within)
    lines: dict[str, Any] = {"p": p, "q": q, "a": a, "b": b}
    wx, wy, ux, uy = q.x - p.x, q.y - p.y, b.x - a.x, b.y - a.y
    det = c.use(cross, p, q, a, b)
    s0 = share(c, (a.x - p.x) * uy - (a.y - p.y) * ux, det)
    t0 = share(c, (a.x - p.x) * wy - (a.y - p.y) * wx, det)
    ways = []
    for u0, u in ((s0, s), (t0, t)):
        outside = c.any_of(u0 < 0, u0 > 1)
        goal = c.when(u0 < 0, 0 - u0, 1 - u0)
        ways.append(c.when(outside, share(c, goal, u - u0), u0 - u0))
    c.lemma(
        "geofence_leg_verdict_misses_no_pair_of_crossing_lines",
        when=det != 0,
        **lines,
        d=d,
        s=s,
        t=t,
        s0=s0,
        t0=t0,
        ks=ways[0],
        kt=ways[1],
    )
    leg, edge, both = wx * wx + wy * wy, ux * ux + uy * uy, wx * ux + wy * uy
    ds = c.when(leg == 0, 1, c.when(edge == 0, 0, both))
    dt = c.when(leg == 0, 0, c.when(edge == 0, 1, leg))
    far = [share(c, c.when(dv > 0, 1 - v, 0 - v), dv) for v, dv in ((s, ds), (t, dt))]
    c.lemma(
        "geofence_leg_verdict_misses_no_pair_of_parallels",
        when=det == 0,
        **lines,
        d=d,
        s=s,
        t=t,
        ks=far[0],
        kt=far[1],
        dx=a.x + t * ux - p.x - s * wx,
        dy=a.y + t * uy - p.y - s * wy,
    )
    for kernel, definition in (
        (leg_nearer, geofence.legs_nearer_at),
        (leg_within, geofence.legs_within_at),
    ):
        pair = c.define(definition, p, q, a, b, d, s, t)
        c.show(c.implies(pair, c.use(kernel, p, q, a, b, d)), kernel.__name__)
