"""A change of altitude holds the asked climb rate, or the present one where that is faster in the same
direction; a lesser one only where it would pass the target with the rate reached, and then it holds it for no
time. It does not fly through a target that it can level off at."""

from typing import Any

from cratous.core.daa.climb import climb
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    z, vz, target, rate, accel = c.reals("z vz target rate accel")
    reach, leave, stop = c.reals("reach leave stop")
    c.premise(rate > 0)
    c.premise(accel > 0)
    t1, t2, _, held = c.use(climb, z, vz, target, rate, accel)

    def heads(side: int) -> None:
        # up with side 1; with -1 everything is mirrored
        up, least = side * vz, c.when(side * vz >= rate, side * vz, rate)
        towards = side * held > 0
        c.show(c.implies(towards, side * held <= least), "no faster")
        # how long it takes to the full rate, and from there to level
        full = c.all_of(accel * reach == least - up, accel * leave == least)
        there = c.define(daa_meaning.accelerated, side * z, up, accel, reach)
        level = c.define(daa_meaning.accelerated, there, least, 0 - accel, leave)
        room = c.all_of(full, level <= side * target)
        c.show(c.implies(c.all_of(towards, room), side * held == least), "as fast, with room")
        c.show(c.implies(c.all_of(towards, side * held < least), t1 == t2), "no time at less")
        at_once = c.define(daa_meaning.accelerated, side * z, up, 0 - accel, stop)
        can: Any = c.all_of(up > 0, accel * stop == up, at_once <= side * target)
        c.show(c.implies(can, side * held >= up), "levels off where it can")

    heads(1)
    heads(-1)
