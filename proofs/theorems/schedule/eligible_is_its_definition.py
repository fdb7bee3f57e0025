"""A vehicle with a one-bit mask is eligible for the kernel exactly when its bit is set among the
eligible ones; whatever its number from 0 to 62."""

from cratous.core.schedule.rows import eligible
from cratous.proofs.claim import Claim
from cratous.spec import schedule


def claim(c: Claim) -> None:
    mask = c.mask("mask")
    for number in range(63):
        verdict = c.use(eligible, mask, c.bits(1 << number))
        member = c.define(schedule.vehicle_is_eligible, number, mask, c.bits(1 << number))
        c.show(c.same(verdict, member), f"vehicle number {number}")
