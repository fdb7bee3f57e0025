"""If the kernel says that well clear by tcpa is lost during [B, T] of straight flight, then it is
lost at an instant of [B, T] that can be named: the first one of the horizontal span within the
vertical window."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_has_a_witness
from cratous.proofs.methods.kinds import TCPA


def claim(c: Claim) -> None:
    detection_has_a_witness(c, TCPA)
