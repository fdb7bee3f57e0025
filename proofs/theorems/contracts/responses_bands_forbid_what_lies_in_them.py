"""A speed or an altitude is forbidden by an interval exactly when it is at no distance from it."""

from cratous.core.contracts.responses import value_blocked
from cratous.proofs.claim import Claim
from cratous.spec.contracts import responses


def claim(c: Claim) -> None:
    value, low, high = c.reals("value low high")
    c.premise(low <= high)
    apart = c.define(responses.apart, value, low, high)
    c.show(c.same(c.use(value_blocked, value, low, high), apart == 0))
