"""From now until the disc has surely left: the span holds every instant of [0, T] at which the quadratic is
not above 0, begins now, and ends at T or where the quadratic is not above 0."""

from cratous.core.daa.uncertainty import leaves_at, until_left
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    a, half, rest, end, t = c.reals("a half rest end t")
    c.premise(a > 0)
    c.opaque(leaves_at)
    first, last = c.use(until_left, a, half, rest, end)
    c.lemma("daa_last_root_is_the_last", a=a, half=half, rest=rest, t=t)
    here = c.define(daa_meaning.not_positive, a, half, rest, t)
    held = c.define(well_clear.in_span, first, last, t)
    c.show(c.implies(c.all_of(t >= 0, t <= end, here), held), "holds them")
    there = first <= last
    c.show(c.implies(there, c.all_of(first == 0, last <= end)), "begins now")
    at_last = c.define(daa_meaning.not_positive, a, half, rest, last)
    c.show(c.implies(there, c.any_of(last == end, at_last)), "ends")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
