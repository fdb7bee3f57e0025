"""The phases of a change of altitude begin now and fit together: from the present vertical speed to the
rate, held, and level at the very target, also where the target is so near that it must be flown through
first."""

from fractions import Fraction

from cratous.core.daa.climb import climb
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning

# z, vz, target, accel, t1, t2, t3, rate
FLOWN = {
    "climbing": (100, -6, 111, 2, 5, 8, 10, 4),
    "descending": (200, 6, 189, 2, 5, 8, 10, -4),
    "climbing, slower than now": (10, 6, 40, 1, 2, 5, 9, 4),
}
# what is different from the first of them
NOT_FLOWN = {
    "level above the target": {"target": 110},
    "level below the target": {"target": 112},
    "held for less than no time": {"target": 95, "t2": 4, "t3": 6},
    "not level at the end": {"target": 110, "t3": 11},
    "not at the rate": {"target": 115, "t1": 3},
}


def claim(c: Claim) -> None:
    # the examples come first: they refute a wrong definition at once, the long claim does not
    for text, flown in FLOWN.items():
        c.show(c.define(daa_meaning.climb_is_flown, *map(Fraction, flown)), f"an example: {text}")
    names = ("z", "vz", "target", "accel", "t1", "t2", "t3", "rate")
    for text, other in NOT_FLOWN.items():
        values = dict(zip(names, FLOWN["climbing"], strict=True)) | other
        c.show(
            c.negation(c.define(daa_meaning.climb_is_flown, *map(Fraction, values.values()))),
            f"an example: {text}",
        )
    z, vz, target, rate, accel = c.reals("z vz target rate accel")
    c.premise(rate > 0)
    c.premise(accel > 0)
    t1, t2, t3, held = c.use(climb, z, vz, target, rate, accel)
    c.show(c.define(daa_meaning.climb_is_flown, z, vz, target, accel, t1, t2, t3, held))
    c.show(t1 >= 0, "not before now")
