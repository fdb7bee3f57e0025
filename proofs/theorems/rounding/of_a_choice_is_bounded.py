"""The lesser, the greater, the magnitude and the negative of computed values, and one of two
chosen by a condition that is certain, stand for those of the real numbers within the greater
bound."""

from cratous.core.readings.exact.certainty import surely_above
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    v1, r1, p1, v2, r2, p2 = c.reals("v1 r1 p1 v2 r2 p2")
    size, bound = c.reals("size bound")
    first = c.boolean("first")
    c.premise(c.define(rounding.near, v1, r1, p1, bound))
    c.premise(c.define(rounding.near, v2, r2, p2, bound))
    c.premise(size >= p1)
    c.premise(size >= p2)
    for text, kind in (("the lesser", lesser), ("the greater", greater)):
        value, real = c.define(kind, v1, v2), c.define(kind, r1, r2)
        c.show(c.define(rounding.near, value, real, size, bound), text)
        c.show(c.implies(c.use(surely_above, value, bound), real > 0), f"{text}: its sign")
    magnitude, real = c.define(abs_of, v1), c.define(abs_of, r1)
    c.show(c.define(rounding.near, magnitude, real, p1, bound), "the magnitude")
    c.show(c.define(rounding.near, -v1, -r1, p1, bound), "the negative")
    value, real = c.when(first, v1, v2), c.when(first, r1, r2)
    c.show(c.define(rounding.near, value, real, c.when(first, p1, p2), bound), "the chosen")


def abs_of(x: float) -> float:
    """The magnitude."""
    return abs(x)


def lesser(x: float, y: float) -> float:
    """The lesser."""
    return min(x, y)


def greater(x: float, y: float) -> float:
    """The greater."""
    return max(x, y)
