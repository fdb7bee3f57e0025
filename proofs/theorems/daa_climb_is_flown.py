"""The phases of a change of altitude begin now and fit together: from the present vertical speed to the
rate, held, and level at the very target, also where the target is so near that it must be flown through
first."""

from cratous.core.daa_climb import climb
from cratous.proofs.claim import Claim
from cratous.spec import daa_meaning


def claim(c: Claim) -> None:
    z, vz, target, rate, accel = c.reals("z vz target rate accel")
    c.premise(rate > 0)
    c.premise(accel > 0)
    t1, t2, t3, held = c.use(climb, z, vz, target, rate, accel)
    c.show(c.define(daa_meaning.climb_is_flown, z, vz, target, accel, t1, t2, t3, held))
    c.show(t1 >= 0, "not before now")
