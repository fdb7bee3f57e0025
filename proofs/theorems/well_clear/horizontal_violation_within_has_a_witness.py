"""If the kernel says that the horizontal volume is violated during [0, h] of straight flight, then
it is violated at an instant of [0, h] that can be named: 0, h, the closest approach, or the
instant of least modified-tau margin."""

from typing import Any

from cratous.core.well_clear import horizontal_violation_within
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, h = c.reals("dthr tthr h")
    closest, least = c.reals("closest least")
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    c.premise(h >= 0)
    c.premise(c.implies(vv > 0, vv * closest + sv == 0))
    c.premise(c.implies(vv > 0, 2 * vv * least + 2 * sv + tthr * vv == 0))
    predicted = c.use(horizontal_violation_within, s, v, dthr, tthr, h)

    def violated(t: Any) -> Any:
        at = c.define(well_clear.horizontal_violation_at, s, v, dthr, tthr, t)
        return c.all_of(t >= 0, t <= h, at)

    now, apart = h - h, c.all_of(s.x * s.x + s.y * s.y > dthr * dthr, vv > 0)
    c.show(c.implies(s.x * s.x + s.y * s.y <= dthr * dthr, violated(now)), "already inside")
    c.show(c.implies(c.all_of(predicted, c.negation(violated(now))), apart), "on a course")
    c.show(c.implies(c.all_of(predicted, apart), sv < 0), "converging")
    reached = c.define(well_clear.within_at, s, v, dthr, closest)
    c.show(c.implies(c.all_of(predicted, apart), reached), "the closest approach")
    passed = c.all_of(predicted, apart, closest <= h)
    c.show(c.implies(passed, violated(closest)), "within the horizon")
    coming = c.all_of(predicted, apart, closest > h)

    def margin(t: Any) -> Any:
        """Not above 0 where tau_mod <= TTHR, once the two converge."""
        a, b = vv, 2 * sv + tthr * vv
        return a * t * t + b * t + s.x * s.x + s.y * s.y + tthr * sv - dthr * dthr

    candidates = (now, h, least)
    below = [c.all_of(t >= 0, t <= h, margin(t) <= 0) for t in candidates]
    c.step(c.implies(coming, c.any_of(*below)), "a margin that is not above 0")
    for t, there in zip(candidates, below, strict=True):
        c.step(c.implies(c.all_of(coming, there), violated(t)), "it is violated there")
    c.show(c.implies(coming, c.any_of(*[violated(t) for t in candidates])), "beyond the horizon")
    c.show(c.implies(predicted, c.any_of(*[violated(t) for t in (now, h, closest, least)])))
