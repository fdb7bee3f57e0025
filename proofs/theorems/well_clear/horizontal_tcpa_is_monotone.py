"""The horizontal volume with tcpa is monotone: a greater DTHR or TTHR never makes a violation
vanish."""

from cratous.core.well_clear import horizontal_violation_tcpa
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import horizontal_is_monotone


def claim(c: Claim) -> None:
    horizontal_is_monotone(c, horizontal_now=horizontal_violation_tcpa)
