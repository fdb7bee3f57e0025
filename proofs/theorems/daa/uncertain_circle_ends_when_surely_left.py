"""Once the circle may be violated, the span for uncertain states goes on while the disc of the position,
which grows with time, still comes within the circle."""

from cratous.core.daa.uncertainty import circle_first, circle_span, circle_straight, until_left
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    es, ev, dthr, tthr, end, t = c.reals("es ev dthr tthr end t")
    for least in (es, ev, dthr, tthr):
        c.premise(least >= 0)
    c.opaque(circle_first, circle_straight, until_left, daa_meaning.may_be_within_at)
    c.premise(t >= 0)
    c.premise(t <= end)
    may = c.define(daa_meaning.may_be_within_at, s, v, es, ev, dthr, t)
    c.premise(may)
    size = {"s": s, "v": v, "es": es, "ev": ev, "dthr": dthr, "end": end}
    moves = v.x * v.x + v.y * v.y > ev * ev
    c.lemma("daa_uncertain_disc_leaves_last", when=moves, t=t, **size)
    first, last = c.use(circle_span, s, v, es, ev, dthr, tthr, end)
    c.show(c.implies(c.all_of(first <= last, first <= t), t <= last))
