"""The horizontal volume does not depend on the unit of length or time: position, DTHR and TTHR
scaled by the same positive factor give the same verdict."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TAUMOD
from cratous.proofs.methods.volumes import horizontal_scales


def claim(c: Claim) -> None:
    horizontal_scales(c, TAUMOD)
