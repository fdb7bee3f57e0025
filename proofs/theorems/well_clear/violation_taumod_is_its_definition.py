"""The combined kernel for taumod says that well clear is lost exactly when the horizontal volume and the
vertical one, by TCOA or VMOD, are violated at once."""

from cratous.core.well_clear import violation_taumod
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import violation_is_its_definition
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    violation_is_its_definition(
        c,
        "well_clear_horizontal_violation_is_its_definition",
        violation_now=violation_taumod,
        meant_horizontally=well_clear.horizontal_violation,
        meant_at=well_clear.violation_taumod_at,
    )
