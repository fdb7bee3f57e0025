"""With time thresholds of zero the volume with tep is the closed cylinder: the definitions are the
same, whatever the velocities."""

from cratous.core.well_clear import violation_tep
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, radius, half, t = c.reals("sz vz radius half t")
    c.premise(radius >= 0)
    c.premise(half >= 0)
    zero = t - t
    limits = Thresholds(radius, half, zero, zero, zero)
    tep = c.define(well_clear.violation_tep_at, s, v, sz, vz, limits, t)
    inside = c.define(well_clear.cylinder_violation_at, s, v, sz, vz, radius, half, t)
    c.show(c.same(tep, inside), "the definitions")
    now = c.define(well_clear.cylinder_violation, s, sz, radius, half)
    kernel = c.use(violation_tep, s, v, sz, vz, limits)
    c.show(c.same(kernel, now), "the kernel")
