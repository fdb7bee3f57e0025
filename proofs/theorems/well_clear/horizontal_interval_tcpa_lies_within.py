"""A span of the horizontal interval kernel with tcpa that is not empty lies within [B, T]; an empty
one is from 1 to 0, and where B is after T it is empty."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TCPA
from cratous.proofs.methods.spans import horizontal_interval_lies_within


def claim(c: Claim) -> None:
    horizontal_interval_lies_within(c, TCPA)
