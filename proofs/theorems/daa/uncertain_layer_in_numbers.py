"""Who is 300 to 320 m above and sinks at 8 to 10 m/s may be within 100 m from 20 s to 52.5 s on, and at
co-altitude from 30 s to 40 s; who does not sink is there at no time, and 0 between two altitudes lies
by their share of the way from the one to the other."""

from fractions import Fraction

from cratous.core.daa.uncertainty import layer_above
from cratous.proofs.claim import Claim
from cratous.spec.daa.meaning import level_at, share_of


def claim(c: Claim) -> None:
    low, high, slow, fast, zthr, none, end = given = c.reals("low high slow fast zthr none end")
    for value, number in zip(given, (300, 320, -10, -8, 100, 0, 60), strict=True):
        c.premise(value == number)
    span = c.use(layer_above, low, high, slow, fast, zthr, none, none, end)
    c.show(c.same(span, (20, Fraction(105, 2))), "within the layer")
    c.show(c.same(c.define(level_at, low, slow), 30), "the first at co-altitude")
    c.show(c.same(c.define(level_at, high, fast), 40), "the last at co-altitude")
    c.show(c.same(c.define(level_at, low, none), 0), "who does not sink")
    c.show(c.same(c.define(share_of, slow, high), Fraction(1, 33)), "0 between")
    c.show(c.same(c.define(share_of, high, low), 0), "the one above the other")
