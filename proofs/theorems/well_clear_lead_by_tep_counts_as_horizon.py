"""With the volume by tep a second of lead counts as a second of horizon: what is taken from the
threshold TTHR and given to the look-ahead changes no verdict, whatever the state."""

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
    c.show(c.same(one, other))
