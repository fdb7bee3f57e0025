"""Where the interval kernel for taumod gives a span that is not empty, the kernel that does not ask
gives the same first and last instant."""

from cratous.core.well_clear import (
    horizontal_interval_taumod,
    times_taumod,
    violation_interval_taumod,
    violation_times_taumod,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.spans import times_are_the_interval


def claim(c: Claim) -> None:
    times_are_the_interval(
        c,
        horizontal_interval=horizontal_interval_taumod,
        horizontal_times=times_taumod,
        violation_interval=violation_interval_taumod,
        violation_times=violation_times_taumod,
    )
