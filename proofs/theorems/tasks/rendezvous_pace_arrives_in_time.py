"""At the speed that is said one arrives within the tolerance of the common time, and it is a speed of the
vehicle; and it is said exactly when some speed of the vehicle does, else whether all are too early or too late."""

from cratous.core.tasks.rendezvous import pace
from cratous.proofs.claim import Claim
from cratous.spec import rendezvous

FLY = 0
EARLY = 1
LATE = 2


def claim(c: Claim) -> None:
    left, until, slowest, fastest = c.reals("left until slowest fastest")
    tolerance, speed = c.reals("tolerance speed")
    c.premise(left >= 0)
    c.premise(slowest > 0)
    c.premise(fastest >= slowest)
    c.premise(tolerance >= 0)
    # any speed of the vehicle
    c.premise(speed >= slowest)
    c.premise(speed <= fastest)
    said = c.use(pace, left, until, slowest, fastest, tolerance)
    flies = said.act == FLY
    own = c.all_of(said.speed_m_s >= slowest, said.speed_m_s <= fastest)
    c.show(c.implies(flies, own), "a speed of the vehicle")
    there = c.define(rendezvous.arrives_within, left, said.speed_m_s, until, tolerance)
    c.show(c.implies(flies, there), "at which it arrives within the tolerance")
    some = c.define(rendezvous.arrives_within, left, speed, until, tolerance)
    c.show(c.implies(some, flies), "said wherever some speed does")
    early, late = left < speed * (until - tolerance), left > speed * (until + tolerance)
    c.show(c.implies(said.act == EARLY, early), "at every speed before it")
    c.show(c.implies(said.act == LATE, late), "at every speed after it")
    c.show(c.any_of(flies, said.act == EARLY, said.act == LATE), "and nothing else is said")
