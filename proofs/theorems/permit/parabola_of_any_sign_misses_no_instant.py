"""If the parabola kernel says that a t^2 + b t + c stays above zero on [0, h], it does so at every instant of
[0, h], whatever the sign of a."""

from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    a, b, k, h, t = c.reals("a b c h t")
    c.premise(h >= 0)
    c.premise(t >= 0)
    c.premise(t <= h)
    dips = c.use(dips_to_zero, a, b, k, h)
    at = c.define(well_clear.parabola, a, b, k, t)
    end = c.define(well_clear.parabola, a, b, k, h)
    # where it opens downwards it is above the straight line between its ends
    c.step(h * at - t * end - (h - t) * k == a * t * h * (t - h), "against the line")
    c.step(c.implies(a <= 0, a * t * h * (t - h) >= 0), "above the line")
    c.step(
        c.implies(c.all_of(a <= 0, k > 0, end > 0, h > 0), t * end + (h - t) * k > 0), "the line"
    )
    c.step(
        c.implies(a > 0, 4 * a * at == (2 * a * t + b) * (2 * a * t + b) - (b * b - 4 * a * k)),
        "square",
    )
    c.show(c.implies(at <= 0, dips))
