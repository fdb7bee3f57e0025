"""The horizontal kernel with tcpa that neither divides nor takes roots says `violated during [0, h]`
exactly when the interval kernel's span over [0, h] is not empty."""

from cratous.core.well_clear import horizontal_interval_tcpa, horizontal_violation_within_tcpa
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import horizontal_detection_is_the_interval


def claim(c: Claim) -> None:
    horizontal_detection_is_the_interval(
        c,
        horizontal_during=horizontal_violation_within_tcpa,
        horizontal_interval=horizontal_interval_tcpa,
    )
