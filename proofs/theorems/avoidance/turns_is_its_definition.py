"""An intruder counts as turning exactly when its course has turned faster than the rate, to either side."""

from cratous.core.avoidance.way_ahead import turns
from cratous.proofs.claim import Claim
from cratous.spec.avoidance import way_ahead


def claim(c: Claim) -> None:
    turn, rate, dt = c.reals("turn rate dt")
    c.premise(c.all_of(rate >= 0, dt > 0))
    said = c.use(turns, turn, rate, dt)
    c.show(c.same(said, c.define(way_ahead.turns, turn, rate, dt)))
