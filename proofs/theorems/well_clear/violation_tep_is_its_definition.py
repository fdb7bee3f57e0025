"""The combined kernel for tep says that well clear is lost exactly when the horizontal volume and the
vertical one, by TCOA or VMOD, are violated at once."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.kinds import TEP
from cratous.proofs.methods.volumes import violation_is_its_definition


def claim(c: Claim) -> None:
    violation_is_its_definition(c, TEP)
