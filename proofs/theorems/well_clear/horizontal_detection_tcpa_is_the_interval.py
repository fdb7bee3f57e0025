"""The horizontal kernel with tcpa that neither divides nor takes roots says `violated during [0, h]`
exactly when the interval kernel's span over [0, h] is not empty."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import horizontal_detection_is_the_interval
from cratous.proofs.methods.kinds import TCPA


def claim(c: Claim) -> None:
    horizontal_detection_is_the_interval(c, TCPA)
