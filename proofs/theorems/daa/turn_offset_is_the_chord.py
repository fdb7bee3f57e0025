"""The offset of a turn step is the chord of its circle: as long as the chord, in the mean direction of
the two velocities, and offsets of consecutive steps add up."""

from cratous.core.daa.turn import turn_offset, turned
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    v, u = c.vector("v"), c.vector("u")
    cos, sin = c.reals("cos sin")
    c.premise(cos * cos + sin * sin == 1)
    w = c.use(turned, v, cos, sin)
    d = c.use(turn_offset, v, w)
    c.show(c.define(daa_meaning.is_arc, v, d, cos, sin), "it leads along the circle")
    other, vv = c.vector("other"), v.x * v.x + v.y * v.y
    as_well = c.all_of(vv > 0, c.define(daa_meaning.is_arc, v, other, cos, sin))
    c.show(c.implies(as_well, c.same(tuple(other), tuple(d))), "nothing else does")
    c.show(d.x * d.x + d.y * d.y == 2 * (1 - cos) * vv, "length")
    c.show(d.x * (v.y + w.y) - d.y * (v.x + w.x) == 0, "direction")
    on = c.use(turn_offset, w, u)
    both = c.use(turn_offset, v, u)
    c.show(c.all_of(d.x + on.x == both.x, d.y + on.y == both.y), "offsets add up")
