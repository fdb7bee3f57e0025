"""A span of the kernel for tcpa that is not empty lies within [B, T], and well clear is lost at its
first instant and at its last; an empty one is from 1 to 0, always."""

from cratous.core.well_clear import horizontal_interval_tcpa, violation_interval_tcpa
from cratous.proofs.claim import Claim
from cratous.proofs.methods.spans import interval_ends_violate
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    interval_ends_violate(
        c,
        ("well_clear_horizontal_interval_tcpa_lies_within", "well_clear_interval_tcpa_is_exact"),
        horizontal_interval=horizontal_interval_tcpa,
        violation_interval=violation_interval_tcpa,
        meant_horizontally_at=well_clear.horizontal_violation_tcpa_at,
        meant_at=well_clear.violation_tcpa_at,
    )
