"""A ground speed no slower than the wind that the kernel refuses takes an airspeed beyond the limits
straight into the wind or straight with it; without wind, in every direction."""

from cratous.core.routing.wind import holds_in_wind
from cratous.proofs.claim import Claim
from cratous.spec.routing import wind


def claim(c: Claim) -> None:
    ground, strength, least, most = c.reals("ground strength least most")
    north, east = c.reals("north east")
    c.premise(c.all_of(least >= 0, most >= 0, strength >= 0, ground >= strength))
    c.premise(north * north + east * east == 1)
    wn, we = strength * north, strength * east
    c.step(wn * wn + we * we == strength * strength, "the wind's strength")
    behind, ahead = ground - strength, ground + strength
    slow = c.define(wind.airspeed_squared, north, east, ground, wn, we)
    fast = c.define(wind.airspeed_squared, -north, -east, ground, wn, we)
    c.step(slow == behind * behind, "with the wind the airspeed is the difference")
    c.step(fast == ahead * ahead, "into the wind it is the sum")
    met = c.all_of(
        c.define(wind.holds, north, east, ground, wn, we, least, most),
        c.define(wind.holds, -north, -east, ground, wn, we, least, most),
    )
    c.step(c.implies(met, c.all_of(least <= behind, ahead <= most)), "so they are within")
    c.show(c.implies(met, c.use(holds_in_wind, ground, wn, we, least, most)))
    for side, airspeed in ((1, 8), (-1, 12)):
        example = c.define(wind.holds, side, 0, 10, 2, 0, airspeed, airspeed)
        c.show(example, "an example: with the wind, and into it")
