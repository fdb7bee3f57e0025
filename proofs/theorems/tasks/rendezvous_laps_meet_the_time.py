"""Who waits in laps before a way that spares a lap, and is too early at the end of one, is not too late at the
end of the next; and who is told of another lap is not too late after it."""

from cratous.core.tasks.rendezvous import another_lap, pace, spares_a_lap
from cratous.proofs.claim import Claim
from cratous.spec import rendezvous

EARLY = 1
LATE = 2


def claim(c: Claim) -> None:
    left, until, lap, slowest = c.reals("left until lap slowest")
    nominal, fastest, tolerance = c.reals("nominal fastest tolerance")
    c.premise(left >= 0)
    c.premise(lap >= 0)
    c.premise(slowest > 0)
    c.premise(nominal >= slowest)
    c.premise(fastest >= nominal)
    c.premise(tolerance >= 0)
    spares = c.use(spares_a_lap, left, lap, slowest, fastest)
    c.show(
        c.same(spares, c.define(rendezvous.spread_of, left, lap, slowest, fastest)),
        "its definition",
    )
    now = c.use(pace, left, until, slowest, fastest, tolerance)
    after = c.use(pace, left, until - lap, slowest, fastest, tolerance)
    late = after.act == LATE
    c.show(
        c.implies(c.all_of(spares, now.act == EARLY), c.negation(late)),
        "too early at the end of one lap, not too late at the end of the next",
    )
    again = c.use(another_lap, left, until, lap, nominal)
    c.show(
        c.same(again, c.define(rendezvous.later_by, left, until, lap, nominal)), "as it is defined"
    )
    c.show(c.implies(again, c.negation(late)), "nor after a lap that was told")
