"""Well clear by tep is symmetric: seen from the intruder, the verdict now and the first and last
instant over [B, T] are those that the ownship sees."""

from cratous.core.well_clear import (
    horizontal_interval_tep,
    horizontal_violation_tep,
    violation_interval_tep,
    violation_tep,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import volume_is_symmetric


def claim(c: Claim) -> None:
    volume_is_symmetric(
        c,
        horizontal_now=horizontal_violation_tep,
        horizontal_interval=horizontal_interval_tep,
        violation_now=violation_tep,
        violation_interval=violation_interval_tep,
    )
