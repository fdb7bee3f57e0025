"""If the parabola kernel says that a t^2 + b t + c reaches zero or less on [0, h], it does so at
an instant of [0, h] that can be named: 0, h, or the vertex -b / 2a."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.parabolas import dip_has_a_witness


def claim(c: Claim) -> None:
    a = c.real("a")
    c.premise(a >= 0)
    dip_has_a_witness(c, a)
