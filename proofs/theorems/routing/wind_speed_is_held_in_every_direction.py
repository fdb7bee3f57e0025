"""A ground speed that the kernel admits takes an airspeed within the limits in every direction over the
ground, whatever the wind."""

from cratous.core.routing.wind import holds_in_wind
from cratous.proofs.claim import Claim
from cratous.spec.routing import wind


def claim(c: Claim) -> None:
    ground, wn, we, least, most = c.reals("ground wn we least most")
    north, east = c.reals("north east")
    c.premise(c.all_of(ground >= 0, least >= 0, most >= 0))
    c.premise(north * north + east * east == 1)
    along, strength = wn * north + we * east, wn * wn + we * we
    across = wn * east - we * north
    c.step(along * along + across * across == strength, "the parts of the wind make up the wind")
    c.step(along * along <= strength, "neither is larger")
    flown = c.define(wind.airspeed_squared, north, east, ground, wn, we)
    parts = ground * ground - 2 * ground * along + strength
    c.step(flown == parts, "the airspeed is that of its parts")
    admitted = c.use(holds_in_wind, ground, wn, we, least, most)
    c.lemma(
        "routing_wind_airspeed_lies_between",
        ground=ground, along=along, wn=wn, we=we, least=least, most=most,
    )  # fmt: skip
    met = c.define(wind.holds, north, east, ground, wn, we, least, most)
    c.show(c.implies(admitted, met))
