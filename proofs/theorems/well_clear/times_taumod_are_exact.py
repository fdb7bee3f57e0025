"""If well clear by taumod is lost at some instant of [B, T], it is lost at exactly the instants of [B, T]
between the first and the last one that the kernel gives, these two included."""

from cratous.core.well_clear import violation_interval_taumod, violation_times_taumod
from cratous.proofs.claim import Claim
from cratous.proofs.methods.spans import times_are_exact
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    times_are_exact(
        c,
        ("well_clear_interval_taumod_is_exact", "well_clear_times_taumod_are_the_interval"),
        violation_interval=violation_interval_taumod,
        violation_times=violation_times_taumod,
        meant_at=well_clear.violation_taumod_at,
    )
