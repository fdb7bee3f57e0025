"""Who sinks at 10 m/s and is to climb by 55 m at 20 m/s, with 10 m/s^2, is at that rate after 3 s, holds it
for one second, and is level at the target after 6 s."""

from cratous.core.daa.climb import climb
from cratous.proofs.claim import Claim
from cratous.spec.daa.meaning import climb_is_flown


def claim(c: Claim) -> None:
    z, vz, target, rate, accel = given = c.reals("z vz target rate accel")
    for value, number in zip(given, (0, -10, 55, 20, 10), strict=True):
        c.premise(value == number)
    found = c.use(climb, z, vz, target, rate, accel)
    c.show(c.same(found, (3, 4, 6, rate)), "the phases")
    c.show(c.define(climb_is_flown, z, vz, target, accel, *found), "they are flown")
