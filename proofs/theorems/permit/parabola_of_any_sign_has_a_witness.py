"""If the parabola kernel says that a t^2 + b t + c reaches zero or less on [0, h], it does so at an instant of
[0, h] that can be named, whatever the sign of a: 0, h, or the vertex."""

from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    a, b, k, h, vertex = c.reals("a b c h vertex")
    c.premise(h >= 0)
    c.premise(c.implies(a > 0, 2 * a * vertex + b == 0))
    dips = c.use(dips_to_zero, a, b, k, h)

    def reached(t: object) -> object:
        inside = c.all_of(t >= 0, t <= h)  # type: ignore[operator]
        return c.all_of(inside, c.define(well_clear.parabola, a, b, k, t) <= 0)

    c.show(c.implies(dips, c.any_of(reached(a - a), reached(h), reached(vertex))))
