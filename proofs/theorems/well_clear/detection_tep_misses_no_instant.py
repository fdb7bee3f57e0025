"""If the kernel says that well clear by tep holds during [B, T] of straight flight, then at no
instant of [B, T] is it lost, for every relative state in space and all thresholds not below zero,
vertically by TCOA or VMOD."""

from cratous.core.well_clear import (
    horizontal_interval_tep,
    horizontal_violation_within_tep,
    violation_during_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_misses_no_instant
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    detection_misses_no_instant(
        c,
        (
            "well_clear_horizontal_interval_tep_is_exact",
            "well_clear_horizontal_detection_tep_is_the_interval",
            "well_clear_horizontal_violation_tep_scales",
        ),
        horizontal_during=horizontal_violation_within_tep,
        horizontal_interval=horizontal_interval_tep,
        violation_during=violation_during_tep,
        meant_horizontally=well_clear.horizontal_violation_tep,
        meant_at=well_clear.violation_tep_at,
    )
