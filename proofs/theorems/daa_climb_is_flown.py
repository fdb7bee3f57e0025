"""The phases of a change of altitude fit together: from the present vertical speed to the rate, held,
and level at the very target, whenever the target is not so near that it must be overshot."""

from cratous.core.daa_climb import climb
from cratous.proofs.claim import Claim
from cratous.spec import daa_meaning


def claim(c: Claim) -> None:
    z, vz, target, rate, accel = c.reals("z vz target rate accel")
    c.premise(rate > 0)
    c.premise(accel > 0)
    up, way = c.when(target < z, 0 - vz, vz), c.when(target < z, z - target, target - z)
    # levelling off from the present vertical speed stays short of the target
    c.premise(c.any_of(up <= 0, up * up <= 2 * accel * way))
    t1, t2, t3, held = c.use(climb, z, vz, target, rate, accel)
    c.show(c.define(daa_meaning.climb_is_flown, z, vz, target, accel, t1, t2, t3, held))
