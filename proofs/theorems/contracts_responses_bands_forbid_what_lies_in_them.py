"""A heading is forbidden by an interval exactly when the direction lies in it or at one of its ends, north
being both 0 and 360; a speed or an altitude exactly when it is at no distance from it."""

from cratous.core.contracts.responses import heading_blocked, value_blocked
from cratous.proofs.claim import Claim
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    value, low, high = c.reals("value low high")
    c.premise(low <= high)
    apart = c.define(responses.apart, value, low, high)
    c.show(c.same(c.use(value_blocked, value, low, high), apart == 0), "values")
    circle = c.all_of(value >= 0, value < 360, low >= 0, high <= 360)
    same = c.same(
        c.use(heading_blocked, value, low, high), c.define(responses.in_band, value, low, high)
    )
    c.show(c.implies(circle, same), "headings")
