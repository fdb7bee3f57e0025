"""At every instant of [B, T] the horizontal volume with taumod is violated exactly if the instant lies
in the span that the interval kernel gives; for every relative state in any frame."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TAUMOD
from cratous.proofs.methods.spans import horizontal_interval_is_exact


def claim(c: Claim) -> None:
    horizontal_interval_is_exact(c, TAUMOD)
