"""At a turn rate the velocity of the steps is the rate of change of their offset: the offset turned a
little further changes by the velocity there, to first order in the sine of the little turn."""

from cratous.core.daa.turn import turn_offset, turned
from cratous.proofs.claim import Claim
from cratous.proofs.methods.turning import any_angle


def claim(c: Claim) -> None:
    v = c.vector("v")
    cos, sin = any_angle(c, "cos", "sin")
    small_cos, small_sin = any_angle(c, "small_cos", "small_sin")
    w = c.use(turned, v, cos, sin)
    x = c.use(turned, w, small_cos, small_sin)
    d, e = c.use(turn_offset, v, w), c.use(turn_offset, v, x)
    # the rest is (1 - small_cos) times the velocity turned by a right angle: of second order
    rest = 1 - small_cos
    c.show(
        c.all_of(
            e.x - d.x == small_sin * w.x + rest * w.y, e.y - d.y == small_sin * w.y - rest * w.x
        )
    )
