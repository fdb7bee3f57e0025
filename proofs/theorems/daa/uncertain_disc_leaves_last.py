"""The span until the disc of the position, which grows with time, has surely left: it holds every instant
of [0, T] at which the disc comes within the circle, begins now, and ends at T or at such an instant."""

from cratous.core.daa.uncertainty import until_left
from cratous.proofs.claim import Claim
from cratous.proofs.methods.uncertainty import any_growing_disc
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    s, v, es, ev, dthr, spare, half, rest = any_growing_disc(c)
    end, t = c.reals("end t")
    c.opaque(until_left, daa_meaning.not_positive, daa_meaning.may_be_within_at)
    first, last = c.use(until_left, spare, half, rest, end)
    values = {"a": spare, "half": half, "rest": rest, "end": end}
    size = {"s": s, "v": v, "es": es, "ev": ev, "dthr": dthr}
    for instant in (t, last):
        c.lemma("daa_until_left_is_until_the_last", t=instant, **values)
        c.lemma("daa_uncertain_disc_comes_within", t=instant, when=instant >= 0, **size)
    may = [c.define(daa_meaning.may_be_within_at, s, v, es, ev, dthr, at) for at in (t, last)]
    held = c.define(well_clear.in_span, first, last, t)
    c.show(c.implies(c.all_of(t >= 0, t <= end, may[0]), held), "holds them")
    c.show(c.implies(first <= last, c.all_of(first == 0, last <= end)), "begins now")
    c.show(c.implies(first <= last, c.any_of(last == end, may[1])), "ends")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
