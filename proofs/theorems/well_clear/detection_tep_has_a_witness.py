"""If the kernel says that well clear by tep is lost during [B, T] of straight flight, then it is
lost at an instant of [B, T] that can be named: the first one of the horizontal span within the
vertical window."""

from cratous.core.well_clear import (
    horizontal_interval_tep,
    horizontal_violation_within_tep,
    violation_during_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_has_a_witness
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    detection_has_a_witness(
        c,
        (
            "well_clear_horizontal_detection_tep_is_the_interval",
            "well_clear_horizontal_interval_tep_lies_within",
            "well_clear_horizontal_interval_tep_is_exact",
            "well_clear_horizontal_violation_tep_scales",
        ),
        horizontal_during=horizontal_violation_within_tep,
        horizontal_interval=horizontal_interval_tep,
        violation_during=violation_during_tep,
        meant_horizontally=well_clear.horizontal_violation_tep,
        meant_at=well_clear.violation_tep_at,
    )
