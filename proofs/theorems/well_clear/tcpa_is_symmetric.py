"""Well clear by tcpa is symmetric: seen from the intruder, the verdict now and the first and last
instant over [B, T] are those that the ownship sees."""

from cratous.core.well_clear import (
    horizontal_interval_tcpa,
    horizontal_violation_tcpa,
    violation_interval_tcpa,
    violation_tcpa,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import volume_is_symmetric


def claim(c: Claim) -> None:
    volume_is_symmetric(
        c,
        horizontal_now=horizontal_violation_tcpa,
        horizontal_interval=horizontal_interval_tcpa,
        violation_now=violation_tcpa,
        violation_interval=violation_interval_tcpa,
    )
