"""The kernel for tep that neither divides nor takes roots says `lost during [B, T]` exactly when
the interval kernel's span is not empty: so it is exactly when some instant of [B, T] violates, and
the first instant of the span is one."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_is_the_interval
from cratous.proofs.methods.kinds import TEP


def claim(c: Claim) -> None:
    detection_is_the_interval(c, TEP)
