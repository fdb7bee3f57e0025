"""If well clear by tep is lost at some instant of [B, T], it is lost at exactly the instants of [B, T]
between the first and the last one that the kernel gives, these two included."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TEP
from cratous.proofs.methods.spans import times_are_exact


def claim(c: Claim) -> None:
    times_are_exact(c, TEP)
