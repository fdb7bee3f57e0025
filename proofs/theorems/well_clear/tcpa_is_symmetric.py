"""Well clear by tcpa is symmetric: seen from the intruder, the verdict now and the first and last
instant over [B, T] are those that the ownship sees."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TCPA
from cratous.proofs.methods.volumes import volume_is_symmetric


def claim(c: Claim) -> None:
    volume_is_symmetric(c, TCPA)
