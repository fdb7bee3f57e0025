"""The phases of a change of altitude begin now and fit together: from the present vertical speed to the
rate, held, and level at the very target, also where the target is so near that it must be flown through
first."""

from fractions import Fraction

from cratous.core.daa_climb import climb
from cratous.proofs.claim import Claim
from cratous.spec import daa_meaning

# level at 2 m after one second up at 1 m/s^2, one held and one down
FLOWN = {"z": 0, "vz": 0, "target": 2, "accel": 1, "t1": 1, "t2": 2, "t3": 3, "rate": 1}
NOT_FLOWN = (
    ("level above the target", {"target": 1}),
    ("level below the target", {"target": 3}),
    ("held for less than no time", {"target": 0, "t2": 0, "t3": 1}),
    ("not level at the end", {"t3": 4, "target": 2}),
    ("not yet at the rate", {"t1": 0, "t2": 1, "t3": 2, "target": Fraction(3, 2)}),
)


def claim(c: Claim) -> None:
    # the examples come first: they refute a wrong definition at once, the long claim does not
    c.show(c.define(daa_meaning.climb_is_flown, *FLOWN.values()), "an example")
    for text, other in NOT_FLOWN:
        flown = c.define(daa_meaning.climb_is_flown, *(FLOWN | other).values())
        c.show(c.negation(flown), f"an example: {text}")
    z, vz, target, rate, accel = c.reals("z vz target rate accel")
    c.premise(rate > 0)
    c.premise(accel > 0)
    t1, t2, t3, held = c.use(climb, z, vz, target, rate, accel)
    c.show(c.define(daa_meaning.climb_is_flown, z, vz, target, accel, t1, t2, t3, held))
    c.show(t1 >= 0, "not before now")
