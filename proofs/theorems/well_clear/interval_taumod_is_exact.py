"""At every instant of [B, T] of straight flight well clear by taumod is lost exactly if the instant
lies in the span that the kernel gives: for every relative state in space, in any frame, and all
thresholds not below zero, vertically by TCOA or VMOD."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TAUMOD
from cratous.proofs.methods.spans import interval_is_exact


def claim(c: Claim) -> None:
    interval_is_exact(c, TAUMOD)
