"""Well clear by taumod is monotone in every threshold: greater DTHR, ZTHR, TTHR, TCOA or VMOD, one or
several of them, never make a violation vanish."""

from cratous.core.well_clear import horizontal_violation, violation_taumod
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import volume_is_monotone


def claim(c: Claim) -> None:
    volume_is_monotone(
        c,
        "well_clear_horizontal_taumod_is_monotone",
        horizontal_now=horizontal_violation,
        violation_now=violation_taumod,
    )
