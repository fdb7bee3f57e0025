"""A recovery distance that is made smaller is smaller by the factor, but never below the least one: it
falls by at least the factor times the least distance until it has reached it, so the search ends."""

from cratous.core.daa.guidance import shrunk
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    size, least, factor = c.reals("size least factor")
    c.premise(least > 0)
    c.premise(size >= least)
    c.premise(factor > 0)
    c.premise(factor < 1)
    after = c.use(shrunk, size, least, factor)
    c.show(c.define(daa_meaning.shrunk, size, after, least, factor), "by the factor")
    c.show(after >= least, "never below the least")
    c.show(c.any_of(after == least, size - after >= factor * least), "by at least so much")
    c.show(c.implies(size == least, after == least), "and stays there")
