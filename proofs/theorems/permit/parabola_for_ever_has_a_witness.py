"""If the kernel says that a t^2 + b t + c reaches zero or less from now on, it does so at an instant that can be
named: now, far off, the vertex, or the root of a straight line."""

from cratous.core.permit.for_ever import ever_dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    a, b, k, far, vertex, root = c.reals("a b c far vertex root")
    # witnesses: where a falling parabola is surely below 0, a vertex, a straight line's root
    size = c.when(b >= 0, b, 0 - b) + c.when(k >= 0, k, 0 - k)
    c.premise(c.implies(a < 0, c.all_of(far >= 1, far * (0 - a) >= size)))
    c.premise(c.implies(a > 0, 2 * a * vertex + b == 0))
    c.premise(c.implies(c.all_of(a == 0, b < 0), root * b + k == 0))
    dips = c.use(ever_dips_to_zero, a, b, k)

    def reached(instant: object) -> object:
        value = c.define(well_clear.parabola, a, b, k, instant)
        return c.all_of(instant >= 0, value <= 0)  # type: ignore[operator]

    there = c.define(well_clear.parabola, a, b, k, far)
    c.step(c.implies(a < 0, there <= far * (a * far + size)), "far off")
    c.step(c.implies(a < 0, far * (a * far + size) <= 0), "below 0")
    low = c.define(well_clear.parabola, a, b, k, vertex)
    c.step(c.implies(a > 0, 4 * a * low == 4 * a * k - b * b), "the lowest")
    instants = (a - a, far, vertex, root)
    c.show(c.implies(dips, c.any_of(*[reached(u) for u in instants])))
