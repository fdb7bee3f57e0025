"""Who comes straight on violates the circle, for uncertain states, at exactly the instants at which the
state does that is nearer and faster by as much as is not known."""

from itertools import pairwise

from cratous.core.daa.uncertainty import circle_straight
from cratous.core.well_clear.interval import horizontal_interval_taumod
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    distance, speed, es, ev, dthr, tthr, end, t = c.reals("distance speed es ev dthr tthr end t")
    for least in (distance, speed, es, ev, dthr, tthr, t):
        c.premise(least >= 0)
    c.premise(t <= end)
    # the same state is judged alike, whatever the judgement is
    c.opaque(horizontal_interval_taumod, well_clear.horizontal_violation)
    span = c.use(circle_straight, distance * distance, speed * speed, es, ev, dthr, tthr, end)
    names = ("s", "v", "dthr", "tthr", "begin", "end")
    for call in c.calls(horizontal_interval_taumod):
        c.lemma(
            "well_clear_horizontal_interval_taumod_is_exact",
            **dict(zip(names, call, strict=True)), t=t,
        )  # fmt: skip
    worst = c.define(daa_meaning.straight_at, distance, speed, es, ev, dthr, tthr, t)
    for one, other in pairwise(c.calls(well_clear.horizontal_violation)):
        c.congruence(well_clear.horizontal_violation, one, other)
    c.show(c.same(c.define(well_clear.in_span, *span, t), worst))
