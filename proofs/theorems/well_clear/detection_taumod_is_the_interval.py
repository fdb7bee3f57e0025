"""The kernel for taumod that neither divides nor takes roots says `lost during [B, T]` exactly when
the interval kernel's span is not empty: so it is exactly when some instant of [B, T] violates, and
the first instant of the span is one."""

from cratous.core.well_clear import (
    horizontal_interval_taumod,
    violation_during_taumod,
    violation_interval_taumod,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_is_the_interval
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    detection_is_the_interval(
        c,
        (
            "well_clear_detection_taumod_has_a_witness",
            "well_clear_interval_taumod_is_exact",
            "well_clear_interval_taumod_first_and_last_violate",
            "well_clear_detection_taumod_misses_no_instant",
        ),
        horizontal_interval=horizontal_interval_taumod,
        violation_during=violation_during_taumod,
        violation_interval=violation_interval_taumod,
        meant_at=well_clear.violation_taumod_at,
    )
