"""For every relative state and all thresholds not below zero, the horizontal kernel with tep says
`violated` exactly when the definition does."""

from cratous.core.well_clear import horizontal_violation_tep
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import horizontal_is_its_definition
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    horizontal_is_its_definition(c, horizontal_violation_tep, well_clear.horizontal_violation_tep)
