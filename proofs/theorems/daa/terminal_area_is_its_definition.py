"""A place is in the terminal area exactly if it is no farther from its axis than the radius, and not
above its height."""

from cratous.core.daa.terminal_area import inside_area
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    east, north, alt, radius, height = c.reals("east north alt radius height")
    c.premise(radius >= 0)
    inside = c.use(inside_area, east, north, alt, radius, height)
    c.show(c.same(inside, c.define(daa_meaning.in_area, east, north, alt, radius, height)))
