"""A turn step with c^2 + s^2 = 1 keeps the speed, turns by that very angle, and two steps are one step
by the sum of their angles; so the velocities of all steps lie on one circle."""

from cratous.core.daa.turn import turned
from cratous.proofs.claim import Claim
from cratous.proofs.methods.turning import any_angle
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    v = c.vector("v")
    cos_a, sin_a = any_angle(c, "cos_a", "sin_a")
    cos_b, sin_b = any_angle(c, "cos_b", "sin_b")
    w = c.use(turned, v, cos_a, sin_a)
    c.show(c.define(daa_meaning.is_turned, v, w, cos_a, sin_a), "it is turned")
    other = c.vector("other")
    as_well = c.define(daa_meaning.is_turned, v, other, cos_a, sin_a)
    c.show(c.implies(as_well, c.same(tuple(other), tuple(w))), "no other velocity is")
    vv = v.x * v.x + v.y * v.y
    c.show(w.x * w.x + w.y * w.y == vv, "speed")
    c.show(v.x * w.x + v.y * w.y == cos_a * vv, "cosine")
    c.show(v.y * w.x - v.x * w.y == sin_a * vv, "sine, right")
    twice = c.use(turned, w, cos_b, sin_b)
    cos, sin = cos_a * cos_b - sin_a * sin_b, sin_a * cos_b + cos_a * sin_b
    c.show(cos * cos + sin * sin == 1, "the sum is an angle")
    c.show(c.same(tuple(twice), tuple(c.use(turned, v, cos, sin))), "two steps are one")
