"""Where the interval kernel for tep gives a span that is not empty, the kernel that does not ask
gives the same first and last instant."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TEP
from cratous.proofs.methods.spans import times_are_the_interval


def claim(c: Claim) -> None:
    times_are_the_interval(c, TEP)
