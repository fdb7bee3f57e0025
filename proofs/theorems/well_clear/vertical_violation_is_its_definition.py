"""For every relative altitude and climb rate and all thresholds not below zero, the vertical
kernel says `violated` exactly when the definition with time to co-altitude does."""

from cratous.core.well_clear import vertical_violation
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import vertical_is_its_definition
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    vertical_is_its_definition(c, "tcoa", vertical_violation, well_clear.vertical_violation)
