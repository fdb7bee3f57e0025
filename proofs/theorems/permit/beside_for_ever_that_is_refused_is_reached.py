"""Against a tube that grows steadily a hold is refused as beside for ever only if there is an instant, which can
be named, at which its centre is no farther from the prediction than the radius."""

from cratous.core.permit.for_ever import beside_for_ever, ever_dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    start, rate, far, vertex, root = c.reals("start rate far vertex root")
    growth = motion.Growth(start, rate, start - start)
    c.premise(c.all_of(start >= 0, rate >= 0))
    c.opaque(ever_dips_to_zero, well_clear.parabola, motion.reached_at)
    beside = c.use(beside_for_ever, s, v, growth)
    a = v.x * v.x + v.y * v.y - rate * rate
    b = 2 * (s.x * v.x + s.y * v.y - start * rate)
    k = s.x * s.x + s.y * s.y - start * start
    # the instants that are named: far off, the closest approach, the only one
    size = c.when(b >= 0, b, 0 - b) + c.when(k >= 0, k, 0 - k)
    c.premise(c.implies(a < 0, c.all_of(far >= 1, far * (0 - a) >= size)))
    c.premise(c.implies(a > 0, 2 * a * vertex + b == 0))
    c.premise(c.implies(c.all_of(a == 0, b < 0), root * b + k == 0))
    named = {"a": a, "b": b, "c": k, "far": far, "vertex": vertex, "root": root}
    c.lemma("permit_parabola_for_ever_has_a_witness", **named)
    some = []
    for t in (start - start, far, vertex, root):
        c.lemma(
            "permit_steady_tube_is_reached_at_a_parabola",
            when=t >= 0, s=s, v=v, start=start, rate=rate, t=t,
        )  # fmt: skip
        some.append(c.all_of(t >= 0, c.define(motion.reached_at, s, v, growth, t)))
    c.show(c.implies(c.negation(beside), c.any_of(*some)))
