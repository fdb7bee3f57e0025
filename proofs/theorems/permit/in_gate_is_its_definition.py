"""A measurement is in the gate of a track exactly when it is within so many standard deviations, beside and in
altitude, whatever the deviations are."""

from cratous.core.permit.association import in_gate
from cratous.proofs.claim import Claim
from cratous.spec.permit import association


def claim(c: Claim) -> None:
    off = c.vector("off")
    up, wide, high, sigmas = c.reals("up wide high sigmas")
    c.premise(c.all_of(wide >= 0, high >= 0, sigmas >= 0))
    said = c.use(in_gate, off, up, wide * wide, high * high, sigmas)
    c.show(c.same(said, c.define(association.gated, off, up, wide, high, sigmas)))
