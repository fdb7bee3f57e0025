"""A ground speed that the kernel refuses takes an airspeed beyond the limits straight into the wind or
straight with it; without wind, in every direction."""

from cratous.core.wind import holds_in_wind
from cratous.proofs.claim import Claim
from cratous.spec import wind


def claim(c: Claim) -> None:
    ground, strength, least, most = c.reals("ground strength least most")
    north, east = c.reals("north east")
    c.premise(c.all_of(ground >= 0, least >= 0, most >= 0, strength >= 0, ground >= strength))
    c.premise(north * north + east * east == 1)
    wn, we = strength * north, strength * east
    admitted = c.use(holds_in_wind, ground, wn, we, least, most)
    with_it = c.define(wind.holds, north, east, ground, wn, we, least, most)
    into_it = c.define(wind.holds, -north, -east, ground, wn, we, least, most)
    c.show(c.implies(c.all_of(with_it, into_it), admitted))
