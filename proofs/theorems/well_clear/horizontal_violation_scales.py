"""The horizontal volume does not depend on the unit of length or time: position, DTHR and TTHR
scaled by the same positive factor give the same verdict."""

from cratous.core.well_clear import horizontal_violation
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import horizontal_scales
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    horizontal_scales(
        c,
        "well_clear_horizontal_violation_is_its_definition",
        horizontal_violation,
        well_clear.horizontal_violation,
    )
