"""The horizontal volume with tau is monotone: a greater DTHR or TTHR never makes a violation
vanish."""

from cratous.core.well_clear import horizontal_violation_tau
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import horizontal_is_monotone


def claim(c: Claim) -> None:
    horizontal_is_monotone(c, horizontal_now=horizontal_violation_tau)
