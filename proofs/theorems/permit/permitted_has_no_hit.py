"""A permitted trajectory does not enter the cylinder of the intruder at any instant, whatever places the vehicle
has within rho of its reference and the intruder in its tube, for every number of pieces."""

from cratous.core.permit.pieces import permitted
from cratous.proofs.claim import Claim
from cratous.proofs.methods.trajectories import is_not_hit


def claim(c: Claim) -> None:
    at = c.real("at")
    is_not_hit(c, permitted, at, lambda begin: 0)
