"""If the kernel says that well clear by tcpa is lost during [B, T] of straight flight, then it is
lost at an instant of [B, T] that can be named: the first one of the horizontal span within the
vertical window."""

from cratous.core.well_clear import (
    horizontal_interval_tcpa,
    horizontal_violation_within_tcpa,
    violation_during_tcpa,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_has_a_witness
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    detection_has_a_witness(
        c,
        (
            "well_clear_horizontal_detection_tcpa_is_the_interval",
            "well_clear_horizontal_interval_tcpa_lies_within",
            "well_clear_horizontal_interval_tcpa_is_exact",
            "well_clear_horizontal_violation_tcpa_scales",
        ),
        horizontal_during=horizontal_violation_within_tcpa,
        horizontal_interval=horizontal_interval_tcpa,
        violation_during=violation_during_tcpa,
        meant_horizontally=well_clear.horizontal_violation_tcpa,
        meant_at=well_clear.violation_tcpa_at,
    )
