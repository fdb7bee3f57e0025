"""In the float filter of every kernel, a verdict that is called certain is the kernel's verdict on
the real numbers, given that the comparisons that are called certain are right."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.rounding import filters, verdicts


def claim(c: Claim) -> None:
    for name, (_, made) in filters().items():
        verdicts(c, name, made)
