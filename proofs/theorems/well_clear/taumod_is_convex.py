"""Well clear by taumod is locally convex: if it is lost at two instants of straight flight, it is lost
at every instant between them, in any frame."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TAUMOD
from cratous.proofs.methods.volumes import volume_is_convex


def claim(c: Claim) -> None:
    volume_is_convex(c, TAUMOD)
