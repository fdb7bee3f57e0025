"""In the float filter of every kernel, each error bound covers what rounding and underflow can do
in its operation, and a comparison that is called certain has the sign of the real difference."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.rounding import bounds, filters


def claim(c: Claim) -> None:
    bounds(c, [made for _, made in filters().values()])
