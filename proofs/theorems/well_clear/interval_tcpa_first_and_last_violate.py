"""A span of the kernel for tcpa that is not empty lies within [B, T], and well clear is lost at its
first instant and at its last; an empty one is from 1 to 0, always."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TCPA
from cratous.proofs.methods.spans import interval_ends_violate


def claim(c: Claim) -> None:
    interval_ends_violate(c, TCPA)
