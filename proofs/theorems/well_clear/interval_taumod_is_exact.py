"""At every instant of [B, T] of straight flight well clear by taumod is lost exactly if the instant
lies in the span that the kernel gives: for every relative state in space, in any frame, and all
thresholds not below zero, vertically by TCOA or VMOD."""

from cratous.core.well_clear import horizontal_interval_taumod, violation_interval_taumod
from cratous.proofs.claim import Claim
from cratous.proofs.methods.spans import interval_is_exact
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    interval_is_exact(
        c,
        (
            "well_clear_horizontal_interval_taumod_is_exact",
            "well_clear_horizontal_interval_taumod_lies_within",
        ),
        horizontal_interval=horizontal_interval_taumod,
        violation_interval=violation_interval_taumod,
        meant_horizontally_at=well_clear.horizontal_violation_at,
        meant_at=well_clear.violation_taumod_at,
    )
