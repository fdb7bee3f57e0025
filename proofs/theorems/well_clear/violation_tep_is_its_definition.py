"""The combined kernel for tep says that well clear is lost exactly when the horizontal volume and the
vertical one, by TCOA or VMOD, are violated at once."""

from cratous.core.well_clear import violation_tep
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import violation_is_its_definition
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    violation_is_its_definition(
        c,
        "well_clear_horizontal_violation_tep_is_its_definition",
        violation_now=violation_tep,
        meant_horizontally=well_clear.horizontal_violation_tep,
        meant_at=well_clear.violation_tep_at,
    )
