"""At every instant of [B, T] of straight flight well clear by tcpa is lost exactly if the instant
lies in the span that the kernel gives: for every relative state in space, in any frame, and all
thresholds not below zero, vertically by TCOA or VMOD."""

from cratous.core.well_clear import horizontal_interval_tcpa, violation_interval_tcpa
from cratous.proofs.claim import Claim
from cratous.proofs.methods.spans import interval_is_exact
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    interval_is_exact(
        c,
        (
            "well_clear_horizontal_interval_tcpa_is_exact",
            "well_clear_horizontal_interval_tcpa_lies_within",
        ),
        horizontal_interval=horizontal_interval_tcpa,
        violation_interval=violation_interval_tcpa,
        meant_horizontally_at=well_clear.horizontal_violation_tcpa_at,
        meant_at=well_clear.violation_tcpa_at,
    )
