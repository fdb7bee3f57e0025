"""A ground speed that the kernel admits takes an airspeed within the limits in every direction over the
ground, whatever the wind."""

from cratous.core.wind import holds_in_wind
from cratous.proofs.claim import Claim
from cratous.spec import wind


def claim(c: Claim) -> None:
    ground, wn, we, least, most = c.reals("ground wn we least most")
    north, east, across = c.reals("north east across")
    c.premise(c.all_of(ground >= 0, least >= 0, most >= 0))
    c.premise(north * north + east * east == 1)
    admitted = c.use(holds_in_wind, ground, wn, we, least, most)
    # along: the wind's part in the direction; its square and that of the part across are the wind's
    along = wn * north + we * east
    c.premise(across == wn * east - we * north)
    squared = along * along + across * across
    c.show(squared == wn * wn + we * we, "the parts of the wind make up the wind")
    within = c.all_of(along <= ground - least, along <= most - ground, -along <= most - ground)
    c.show(c.implies(admitted, within), "no part is larger than the wind")
    met = c.define(wind.holds, north, east, ground, wn, we, least, most)
    c.show(c.implies(admitted, met))
