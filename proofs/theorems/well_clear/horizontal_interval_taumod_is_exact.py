"""At every instant of [B, T] the horizontal volume with taumod is violated exactly if the instant lies
in the span that the interval kernel gives; for every relative state in any frame."""

from cratous.core.well_clear import horizontal_interval_taumod
from cratous.proofs.claim import Claim
from cratous.proofs.methods.spans import horizontal_interval_is_exact
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    horizontal_interval_is_exact(
        c,
        horizontal_interval=horizontal_interval_taumod,
        meant_horizontally_at=well_clear.horizontal_violation_at,
    )
