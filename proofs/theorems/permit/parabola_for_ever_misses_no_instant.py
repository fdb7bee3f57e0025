"""If the kernel says that a t^2 + b t + c stays above zero from now on, it does so at every instant."""

from cratous.core.permit.for_ever import ever_dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    a, b, k, t = c.reals("a b c t")
    c.premise(t >= 0)
    dips = c.use(ever_dips_to_zero, a, b, k)
    at = c.define(well_clear.parabola, a, b, k, t)
    square = (2 * a * t + b) * (2 * a * t + b) - (b * b - 4 * a * k)
    c.step(4 * a * at == square, "the square")
    c.step(c.implies(b >= 0, b * t >= 0), "a term that rises")
    c.step(c.implies(a >= 0, a * t * t >= 0), "another")
    c.show(c.implies(at <= 0, dips))
