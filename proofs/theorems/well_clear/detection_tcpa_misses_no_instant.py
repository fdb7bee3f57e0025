"""If the kernel says that well clear by tcpa holds during [B, T] of straight flight, then at no
instant of [B, T] is it lost, for every relative state in space and all thresholds not below zero,
vertically by TCOA or VMOD."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import detection_misses_no_instant
from cratous.proofs.methods.kinds import TCPA


def claim(c: Claim) -> None:
    detection_misses_no_instant(c, TCPA)
