"""The altitude of a climb is the flown one at every instant: accelerated towards the held rate until the
first phase ends, at that rate until the second does, accelerated back until the third, then the target."""

from cratous.core.daa.climb import Climb, height
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    z, vz, target, accel, t = c.reals("z vz target accel t")
    t1, t2, t3, held = c.reals("t1 t2 t3 held")
    first = c.when(held >= vz, accel, 0 - accel)
    met = vz + first * t1 == held  # the held rate is reached when the first phase ends
    c.premise(t1 <= t2)
    c.premise(t2 <= t3)
    now = c.use(height, z, vz, target, accel, Climb(t1, t2, t3, held), t)
    flown = c.define(daa_meaning.accelerated, z, vz, first, t)
    c.show(c.implies(t <= t1, c.all_of(now.z_m == flown, now.vz_m_s == vz + first * t)), "first")
    begun = c.define(daa_meaning.accelerated, z, vz, first, t1)
    steady = c.all_of(now.z_m == begun + held * (t - t1), now.vz_m_s == held)
    c.show(c.implies(c.all_of(met, t1 < t, t <= t2), steady), "held")
    last = c.when(held > 0, 0 - accel, accel)
    there = begun + held * (t2 - t1)
    levels = c.define(daa_meaning.accelerated, there, held, last, t - t2)
    levelling = c.all_of(now.z_m == levels, now.vz_m_s == held + last * (t - t2))
    c.show(c.implies(c.all_of(met, t2 < t, t <= t3), levelling), "levelling off")
    c.show(c.implies(t > t3, c.all_of(now.z_m == target, now.vz_m_s == 0)), "level")
