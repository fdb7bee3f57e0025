"""Between two neighbouring parameters of a leg's crossings, the part of the leg from one point to a
later one meets an edge only if both of these points are on it."""

from typing import Any

from cratous.core.geofence.passages import crossing, foot
from cratous.core.geofence.planar import on_segment, segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.crossings import crossing_named, feet_named, undisturbed
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    t, u, low, high = c.reals("t u low high")
    c.premise(low < t)
    c.premise(t <= u)
    c.premise(u < high)
    here, there = (Vec2(*c.define(geofence.along, p, q, s)) for s in (t, u))
    c.opaque(segments_meet, on_segment, crossing, foot)
    undisturbed(c, p, q, a, b, low, high)
    # parameters that the lemmas want: of the leg's feet, and of the part's own crossing and feet
    i, j, s, r, f, g = c.reals("i j s r f g")
    feet_named(c, p, q, a, b, i, j)
    feet_named(c, here, there, a, b, f, g)
    crossing_named(c, here, there, a, b, s, r)
    c.lemma(
        "geofence_contact_is_at_a_point_of_the_leg",
        p=here,
        q=there,
        a=a,
        b=b,
        s=s,
        t=r,
        f=f,
        g=g,
    )
    same: dict[str, Any] = {"p": p, "q": q, "a": a, "b": b, "low": low, "high": high}
    for v in (s - s, s - s + 1, s, f, g):
        inside = c.all_of(v >= 0, v <= 1)
        w = t + v * (u - t)
        for at in (t, u):
            c.lemma(
                "geofence_contact_is_constant_between_crossings",
                when=inside,
                t=w,
                u=at,
                s=i,
                w=j,
                **same,
            )
        there_ = Vec2(*c.define(geofence.along, p, q, w))
        part = Vec2(*c.define(geofence.along, here, there, v))
        c.congruence(on_segment, (part, a, b), (there_, a, b))
    meet = c.use(segments_meet, here, there, a, b)
    for at in (here, there):
        c.show(c.implies(meet, c.use(on_segment, at, a, b)))
