"""Of a tube that grows steadily the radius is reached at an instant exactly when a parabola in time is at zero or
below it: distance squared less radius squared."""

from cratous.core.permit.pieces import reach_after
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    start, rate, t = c.reals("start rate t")
    c.premise(c.all_of(start >= 0, rate >= 0, t >= 0))
    growth = motion.Growth(start, rate, start - start)
    line = c.use(reach_after, growth, t)
    a = v.x * v.x + v.y * v.y - rate * rate
    b = 2 * (s.x * v.x + s.y * v.y - start * rate)
    value = c.define(well_clear.parabola, a, b, s.x * s.x + s.y * s.y - start * start, t)
    x, y = s.x + t * v.x, s.y + t * v.y
    c.step(t * rate >= 0, "no radius below 0")
    c.step(value == x * x + y * y - line * line, "the square")
    c.show(c.same(c.define(motion.reached_at, s, v, growth, t), value <= 0))
