"""If the kernel says that well clear by taumod is lost during [B, T] of straight flight, then it is
lost at an instant of [B, T] that can be named: the first one of the horizontal span within the
vertical window."""

from cratous.core.well_clear import (
    horizontal_interval_taumod,
    horizontal_violation_within,
    violation_during_taumod,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_has_a_witness
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    detection_has_a_witness(
        c,
        (
            "well_clear_horizontal_detection_taumod_is_the_interval",
            "well_clear_horizontal_interval_taumod_lies_within",
            "well_clear_horizontal_interval_taumod_is_exact",
            "well_clear_horizontal_violation_scales",
        ),
        horizontal_during=horizontal_violation_within,
        horizontal_interval=horizontal_interval_taumod,
        violation_during=violation_during_taumod,
        meant_horizontally=well_clear.horizontal_violation,
        meant_at=well_clear.violation_taumod_at,
    )
