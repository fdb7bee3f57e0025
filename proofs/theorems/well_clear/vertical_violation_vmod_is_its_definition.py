"""For every relative altitude and climb rate and all thresholds not below zero, the vertical kernel
with VMOD says `violated` exactly when the definition does."""

from cratous.core.well_clear import vertical_violation_vmod
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import vertical_is_its_definition
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    vertical_is_its_definition(
        c, "vmod", vertical_violation_vmod, well_clear.vertical_violation_vmod
    )
