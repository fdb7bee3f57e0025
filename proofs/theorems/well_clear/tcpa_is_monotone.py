"""Well clear by tcpa is monotone in every threshold: greater DTHR, ZTHR, TTHR, TCOA or VMOD, one or
several of them, never make a violation vanish."""

from cratous.core.well_clear import horizontal_violation_tcpa, violation_tcpa
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import volume_is_monotone


def claim(c: Claim) -> None:
    volume_is_monotone(
        c,
        "well_clear_horizontal_tcpa_is_monotone",
        horizontal_now=horizontal_violation_tcpa,
        violation_now=violation_tcpa,
    )
