"""The offset of a turn step is the chord of its circle: as long as the chord, in the mean direction of
the two velocities, and offsets of consecutive steps add up."""

from cratous.core.daa_turn import turn_offset, turned
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    v, u = c.vector("v"), c.vector("u")
    cos, sin = c.reals("cos sin")
    c.premise(cos * cos + sin * sin == 1)
    w = c.use(turned, v, cos, sin)
    d = c.use(turn_offset, v, w)
    vv = v.x * v.x + v.y * v.y
    c.show(d.x * d.x + d.y * d.y == 2 * (1 - cos) * vv, "length")
    c.show(d.x * (v.y + w.y) - d.y * (v.x + w.x) == 0, "direction")
    on = c.use(turn_offset, w, u)
    both = c.use(turn_offset, v, u)
    c.show(c.all_of(d.x + on.x == both.x, d.y + on.y == both.y), "offsets add up")
