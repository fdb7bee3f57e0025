"""What a piece has to spare against the chord of a tube's radius is no more, at any instant of its tail, than what
the tail has to spare against its own chord."""

from cratous.core.permit.pieces import growth_after
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    start, rate, gain, d, k, t = c.reals("start rate gain d k t")
    c.premise(c.all_of(start >= 0, rate >= 0, gain >= 0))
    c.premise(c.all_of(k >= 0, k <= d, t >= 0, t <= d - k))
    left = c.use(growth_after, motion.Growth(start, rate, gain), k)
    now, x, y = left.start_m, s.x + k * v.x, s.y + k * v.y
    chord, tail = rate + d * gain, left.rate_m_s + (d - k) * left.gain_m_s2
    speed = v.x * v.x + v.y * v.y
    begun, later = s.x * v.x + s.y * v.y, x * v.x + y * v.y
    a, b = speed - chord * chord, 2 * (begun - start * chord)
    p, q = speed - tail * tail, 2 * (later - now * tail)
    at = c.define(well_clear.parabola, a, b, s.x * s.x + s.y * s.y - start * start, k + t)
    its = c.define(well_clear.parabola, p, q, x * x + y * y - now * now, t)
    line, lower = start + (k + t) * chord, now + t * tail
    c.step(at - its == lower * lower - line * line, "the same distance")
    c.step(line - lower == (k * gain) * (d - k - t), "the chord against the chord of the tail")
    c.step(c.all_of(k * gain >= 0, k * rate >= 0), "no growth below 0")
    c.step(c.all_of((k * gain) * (d - k - t) >= 0, (k * gain) * k >= 0), "nor what it adds")
    c.step(c.all_of(now >= 0, (d - k) * gain >= 0, tail >= 0), "nor the tail's")
    c.step(t * tail >= 0, "nor later")
    c.step(c.all_of(lower >= 0, line >= lower), "at each instant")
    c.step(lower * lower <= line * line, "in squares")
    c.show(at <= its)
