"""With the volume by tep a second of lead counts as a second of horizon: what is taken from the
threshold TTHR and given to the look-ahead changes no verdict, whatever the state."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import horizontal_violation_within_tep
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr, horizon, moved = c.reals("dthr tthr horizon moved")
    for threshold in (dthr, tthr, horizon):
        c.premise(threshold >= 0)
    c.premise(moved >= 0)
    c.premise(moved <= tthr)
    one = c.use(horizontal_violation_within_tep, s, v, dthr, tthr, horizon)
    other = c.use(horizontal_violation_within_tep, s, v, dthr, tthr - moved, horizon + moved)
    c.show(c.same(one, other), "every verdict")
    # examples: 5 apart and closing with 1, they are within 1 after 4
    apart, closing = Vec2(5, 0), Vec2(-1, 0)
    for lead, ahead, wanted in ((0, 4, True), (3, 1, True), (4, 0, True), (1, 2, False)):
        found = c.use(horizontal_violation_within_tep, apart, closing, 1, lead, ahead)
        c.show(c.same(found, wanted), "an example")
