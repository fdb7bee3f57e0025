"""A greater TCOA never ends a span of the vertical kernel, leaves its last instant as it is, and makes
the first one at most as much earlier as the layer grows, divided by the climb rate."""

from cratous.core.well_clear import vertical_interval
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    sz, vz, zthr, tcoa, tcoa2, begin, end = c.reals("sz vz zthr tcoa tcoa2 begin end")
    c.premise(zthr >= 0)
    c.premise(tcoa >= 0)
    c.premise(tcoa <= tcoa2)
    before = c.use(vertical_interval, sz, vz, zthr, tcoa, 0, begin, end)
    after = c.use(vertical_interval, sz, vz, zthr, tcoa2, 0, begin, end)
    some = before.first_s <= before.last_s
    c.show(c.implies(some, after.first_s <= before.first_s), "never later")
    c.show(c.implies(some, after.last_s == before.last_s), "the same end")
    rate = c.when(vz >= 0, vz, 0 - vz)
    least = c.when(tcoa * rate >= zthr, tcoa * rate, zthr)
    most = c.when(tcoa2 * rate >= zthr, tcoa2 * rate, zthr)
    earlier = (before.first_s - after.first_s) * rate
    c.show(c.implies(some, earlier <= most - least), "at most so much earlier")
