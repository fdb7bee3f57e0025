"""A quadratic that opens upwards is above 0 at every time after its last root, and is 0 there if it has
one."""

from fractions import Fraction as Q

from cratous.core.daa.uncertainty import leaves_at
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    a, half, rest, t = c.reals("a half rest t")
    c.premise(a > 0)
    last = c.use(leaves_at, a, half, rest)
    c.show(c.define(daa_meaning.last_root, a, half, rest, t, last))
    # x^2 - 1 is not above 0 at 3/4, so 1/2 is not its last root
    c.show(c.negation(c.define(daa_meaning.last_root, 1, 0, -1, Q(3, 4), Q(1, 2))), "an example")
    c.show(
        c.implies(half * half >= a * rest, c.define(daa_meaning.not_positive, a, half, rest, last)),
        "attained",
    )
