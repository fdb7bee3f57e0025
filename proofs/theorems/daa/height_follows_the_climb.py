"""The altitude during a climb begins at the present one with the present vertical speed, has the held
rate from the first phase to the second, and from the last one on it is the target, without jumps."""

from cratous.core.daa.climb import Climb, climb, height
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    z, vz, target, rate, accel, t = c.reals("z vz target rate accel t")
    c.premise(rate > 0)
    c.premise(accel > 0)
    c.opaque(climb)
    phases = c.use(climb, z, vz, target, rate, accel)
    t1, t2, t3, held = phases
    c.lemma("daa_climb_is_flown", z=z, vz=vz, target=target, rate=rate, accel=accel)
    begin = c.use(height, z, vz, target, accel, Climb(t1, t2, t3, held), t - t)
    c.show(c.all_of(t1 >= 0, begin.z_m == z, begin.vz_m_s == vz), "begin")
    now = c.use(height, z, vz, target, accel, Climb(t1, t2, t3, held), t)
    c.show(c.implies(c.all_of(t1 < t, t <= t2), now.vz_m_s == held), "held")
    c.show(c.implies(t > t3, c.all_of(now.z_m == target, now.vz_m_s == 0)), "level")
