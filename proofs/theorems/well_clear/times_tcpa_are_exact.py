"""If well clear by tcpa is lost at some instant of [B, T], it is lost at exactly the instants of [B, T]
between the first and the last one that the kernel gives, these two included."""

from cratous.core.well_clear import violation_interval_tcpa, violation_times_tcpa
from cratous.proofs.claim import Claim
from cratous.proofs.methods.spans import times_are_exact
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    times_are_exact(
        c,
        ("well_clear_interval_tcpa_is_exact", "well_clear_times_tcpa_are_the_interval"),
        violation_interval=violation_interval_tcpa,
        violation_times=violation_times_tcpa,
        meant_at=well_clear.violation_tcpa_at,
    )
