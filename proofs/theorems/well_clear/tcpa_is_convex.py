"""Well clear by tcpa is locally convex: if it is lost at two instants of straight flight, it is lost
at every instant between them, in any frame."""

from cratous.core.well_clear import violation_interval_tcpa
from cratous.proofs.claim import Claim
from cratous.proofs.methods.volumes import volume_is_convex
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    volume_is_convex(
        c,
        "well_clear_interval_tcpa_is_exact",
        violation_interval=violation_interval_tcpa,
        meant_at=well_clear.violation_tcpa_at,
    )
