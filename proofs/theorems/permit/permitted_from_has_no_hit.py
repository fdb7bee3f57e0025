"""A trajectory that is permitted from an instant on does not enter the cylinder of the intruder at that instant or
any after it, whatever places the vehicle has within rho of its reference and the intruder in its tube, for
every number of pieces."""

from cratous.core.permit.pieces import permitted_from
from cratous.proofs.claim import Claim
from cratous.proofs.methods.trajectories import is_not_hit


def claim(c: Claim) -> None:
    at, gone = c.reals("at gone")
    c.premise(at >= gone)
    is_not_hit(
        c,
        permitted_from,
        at,
        lambda begin: c.when(gone - begin >= 0, gone - begin, 0),
        gone,
    )
