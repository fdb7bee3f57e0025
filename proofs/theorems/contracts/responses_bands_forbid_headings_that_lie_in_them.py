"""A heading is forbidden by an interval exactly when the direction lies in it or at one of its ends, north
being both 0 and 360."""

from cratous.core.contracts.responses import heading_blocked
from cratous.proofs.claim import Claim
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    heading, low, high = c.reals("heading low high")
    c.premise(c.all_of(heading >= 0, heading < 360))
    c.premise(c.all_of(low >= 0, low <= high, high <= 360))
    blocked = c.use(heading_blocked, heading, low, high)
    c.show(c.same(blocked, c.define(responses.in_band, heading, low, high)))
