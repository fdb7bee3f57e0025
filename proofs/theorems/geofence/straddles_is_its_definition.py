"""Two numbers straddle zero exactly when their product is not positive."""

from cratous.core.geofence.planar import straddles
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    one, other = c.reals("one other")
    c.show(c.same(c.use(straddles, one, other), one * other <= 0))
