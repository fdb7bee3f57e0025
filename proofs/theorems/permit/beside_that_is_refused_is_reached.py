"""Where the radius grows steadily, a piece is refused as beside only if there is an instant of it, which can
be named, at which the centres are no farther apart than the radius."""

from cratous.core.permit.pieces import beside_during
from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    start, rate, d, vertex = c.reals("start rate d vertex")
    c.premise(c.all_of(start >= 0, rate >= 0, d >= 0))
    growth = motion.Growth(start, rate, start - start)
    c.opaque(dips_to_zero)
    beside = c.use(beside_during, s, v, growth, d)
    a = v.x * v.x + v.y * v.y - rate * rate
    b = 2 * (s.x * v.x + s.y * v.y - start * rate)
    k = s.x * s.x + s.y * s.y - start * start
    # the instant of the closest approach to the growing circle, where there is one
    c.premise(c.implies(a > 0, 2 * a * vertex + b == 0))
    c.lemma("permit_parabola_of_any_sign_has_a_witness", a=a, b=b, c=k, h=d, vertex=vertex)

    some = []
    for t in (d - d, d, vertex):
        x, y = s.x + t * v.x, s.y + t * v.y
        line = start + t * rate
        c.step(a * t * t + b * t + k == x * x + y * y - line * line, "the square")
        c.step(c.define(motion.reach, growth, t) == line, "the radius")
        reached = c.define(motion.reached_at, s, v, growth, t)
        c.step(c.implies(a * t * t + b * t + k <= 0, reached), "then it is reached")
        some.append(c.all_of(t >= 0, t <= d, reached))
    c.show(c.implies(c.negation(beside), c.any_of(*some)))
