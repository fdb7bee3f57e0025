"""The kernel that says whether two aircraft will be in one cylinder misses no later instant, and where it
says so, there is one: the begin or the end of the time at one height, or the closest approach."""

from typing import Any

from cratous.core.daa.coordination import enters_cylinder
from cratous.core.kernel import Vec2
from cratous.core.well_clear import within_during
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, radius, half, t = c.reals("sz vz radius half t")
    begin, end, closest = c.reals("begin end closest")
    c.premise(radius >= 0)
    c.premise(half >= 0)
    c.premise(t >= 0)
    c.premise(c.negation(vz == 0))
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    c.premise(c.implies(vv > 0, vv * closest + sv == 0))
    # when the heights are within half of each other
    c.premise(c.implies(vz > 0, c.all_of(begin * vz == 0 - half - sz, end * vz == half - sz)))
    c.premise(c.implies(vz < 0, c.all_of(begin * vz == half - sz, end * vz == 0 - half - sz)))
    c.opaque(within_during, well_clear.within)
    found = c.use(enters_cylinder, s, v, sz, vz, radius, half)

    # in scaled time the height grows with rate 1, and the relative position is w times as far away
    w, z = c.when(vz > 0, vz, 0 - vz), c.when(vz > 0, sz, 0 - sz)
    first = c.when(0 - half - z > 0, 0 - half - z, 0)
    length = half - z - first
    at = Vec2(s.x * w + first * v.x, s.y * w + first * v.y)
    for args in c.calls(within_during):
        c.congruence(within_during, (at, v, radius * w, length), args)

    def place(scaled: Any) -> tuple[Any, Any]:
        return Vec2(at.x + scaled * v.x, at.y + scaled * v.y), radius * w

    inside = []
    zero = length - length
    for time in (t, t - t, begin, end, closest):
        scaled = w * time - first
        during = c.all_of(scaled >= 0, scaled <= length)
        there = Vec2(s.x + time * v.x, s.y + time * v.y)
        c.lemma("well_clear_within_during_scales", s=there, v=v, radius=radius, h=t - t, k=w)
        for same in ((Vec2(w * there.x, w * there.y), w * radius), place(zero), place(length)):
            c.congruence(well_clear.within, place(scaled), same)
        in_it = c.define(daa_coordination.in_cylinder_at, s, v, sz, vz, radius, half, time)
        inside.append(c.all_of(time >= 0, in_it))
        near = c.define(well_clear.within, *place(scaled))
        c.step(c.same(inside[-1], c.all_of(during, near)), "in scaled time")
        c.lemma(
            "well_clear_within_during_is_exact", when=during, s=at, v=v, radius=radius * w,
            h=length, t=scaled, closest=w * closest - first,
        )  # fmt: skip
    c.show(c.implies(inside[0], found), "no instant is missed")
    c.show(c.implies(found, c.any_of(*inside[1:])), "one can be named")
