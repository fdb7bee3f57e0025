"""The horizontal volume with tcpa does not depend on the unit of length or time: position, DTHR and TTHR
scaled by the same positive factor give the same verdict."""

from cratous.core.well_clear import horizontal_violation_tcpa
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import horizontal_scales
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    horizontal_scales(
        c,
        "well_clear_horizontal_violation_tcpa_is_its_definition",
        horizontal_violation_tcpa,
        well_clear.horizontal_violation_tcpa,
    )
