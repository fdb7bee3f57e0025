"""Whatever part of the wind lies along the way, a ground speed that the kernel admits takes an airspeed
within the limits."""

from cratous.core.routing.wind import holds_in_wind
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    ground, along, wn, we, least, most = c.reals("ground along wn we least most")
    c.premise(c.all_of(ground >= 0, least >= 0, most >= 0))
    c.premise(along * along <= wn * wn + we * we)
    admitted = c.use(holds_in_wind, ground, wn, we, least, most)
    within = c.all_of(along <= ground - least, -along <= most - ground)
    c.step(c.implies(admitted, within), "no part is larger than the wind")
    squared = ground * ground - 2 * ground * along + (wn * wn + we * we)
    c.show(c.implies(admitted, squared <= most * most), "not too fast")
    c.show(c.implies(admitted, least * least <= squared), "not too slow")
