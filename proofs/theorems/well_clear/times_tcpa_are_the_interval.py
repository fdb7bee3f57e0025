"""Where the interval kernel for tcpa gives a span that is not empty, the kernel that does not ask
gives the same first and last instant."""

from cratous.core.well_clear import (
    horizontal_interval_tcpa,
    times_tcpa,
    violation_interval_tcpa,
    violation_times_tcpa,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.spans import times_are_the_interval


def claim(c: Claim) -> None:
    times_are_the_interval(
        c,
        horizontal_interval=horizontal_interval_tcpa,
        horizontal_times=times_tcpa,
        violation_interval=violation_interval_tcpa,
        violation_times=violation_times_tcpa,
    )
