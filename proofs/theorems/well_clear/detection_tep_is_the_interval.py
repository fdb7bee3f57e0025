"""The kernel for tep that neither divides nor takes roots says `lost during [B, T]` exactly when
the interval kernel's span is not empty: so it is exactly when some instant of [B, T] violates, and
the first instant of the span is one."""

from cratous.core.well_clear import (
    horizontal_interval_tep,
    violation_during_tep,
    violation_interval_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_is_the_interval
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    detection_is_the_interval(
        c,
        (
            "well_clear_detection_tep_has_a_witness",
            "well_clear_interval_tep_is_exact",
            "well_clear_interval_tep_first_and_last_violate",
            "well_clear_detection_tep_misses_no_instant",
        ),
        horizontal_interval=horizontal_interval_tep,
        violation_during=violation_during_tep,
        violation_interval=violation_interval_tep,
        meant_at=well_clear.violation_tep_at,
    )
