"""For every relative state and all thresholds not below zero, the horizontal well-clear kernel
says `violated` exactly when the definition with modified tau does."""

from cratous.core.well_clear import horizontal_violation
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import horizontal_is_its_definition
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    horizontal_is_its_definition(c, horizontal_violation, well_clear.horizontal_violation)
