"""The span of the worst horizontal state, on a turned course or straight on, lies within [0, T], or holds
no instant."""

from cratous.core.daa.turn import turned
from cratous.core.daa.uncertainty import circle_first, circle_straight
from cratous.core.well_clear.interval import horizontal_interval_taumod
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    ss, vv, es, ev, dthr, tthr, end = c.reals("ss vv es ev dthr tthr end")
    for least in (es, ev, dthr, tthr, end):
        c.premise(least >= 0)
    c.opaque(turned, horizontal_interval_taumod)
    worst = c.use(circle_first, s, v, es, ev, dthr, tthr, end)
    straight = c.use(circle_straight, ss, vv, es, ev, dthr, tthr, end)
    for args in c.calls(horizontal_interval_taumod):
        names = ("s", "v", "dthr", "tthr", "begin", "end")
        c.lemma(
            "well_clear_horizontal_interval_taumod_lies_within",
            **dict(zip(names, args, strict=True)),
        )
    for found in (worst, straight):
        first, last = found
        c.show(c.implies(first <= last, c.all_of(first >= 0, last <= end)))
