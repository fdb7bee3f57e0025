"""Well clear by tcpa is monotone in every threshold: greater DTHR, ZTHR, TTHR, TCOA or VMOD, one or
several of them, never make a violation vanish."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TCPA
from cratous.proofs.methods.volumes import volume_is_monotone


def claim(c: Claim) -> None:
    volume_is_monotone(c, TCPA)
