"""The disc of the position, which grows with time, comes within the circle exactly while the quadratic of
the kernel is not above 0."""

from cratous.core.daa.uncertainty import leaves_at
from cratous.proofs.claim import Claim
from cratous.proofs.methods.uncertainty import any_growing_disc
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    s, v, es, ev, dthr, spare, half, rest = any_growing_disc(c)
    t = c.real("t")
    c.premise(t >= 0)
    may = c.define(daa_meaning.may_be_within_at, s, v, es, ev, dthr, t)
    sign = c.define(daa_meaning.not_positive, spare, half, rest, t)
    c.show(c.same(may, sign))
    c.lemma("daa_last_root_is_the_last", a=spare, half=half, rest=rest, t=t)
    last = c.use(leaves_at, spare, half, rest)
    c.show(c.implies(may, t <= last), "not after the last root")
