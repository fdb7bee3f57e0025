"""What is left of a piece that is taken to be clear of an intruder, after any part of it has been flown, is
taken to be clear of it too, by the tube as it has grown until then."""

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import (
    Growth,
    above_during,
    beside_during,
    growth_after,
    piece_clear,
)
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, rho, radius, half, d, k = c.reals("sz vz rho radius half d k")
    wide = Growth(*c.reals("wide_start wide_rate wide_gain"))
    high = Growth(*c.reals("high_start high_rate high_gain"))
    for growth in (wide, high):
        c.premise(c.all_of(growth.start_m >= 0, growth.rate_m_s >= 0, growth.gain_m_s2 >= 0))
    c.premise(c.all_of(rho >= 0, radius >= 0, half >= 0))
    c.premise(c.all_of(k >= 0, k <= d))
    c.opaque(above_during, beside_during, motion.levelled_at)
    clear = c.use(piece_clear, s, v, sz, vz, wide, high, radius, half, rho, d)
    there, height = Vec2(s.x + k * v.x, s.y + k * v.y), sz + k * vz
    later, layer_later = c.use(growth_after, wide, k), c.use(growth_after, high, k)
    size = (radius, half, rho)
    after = c.use(piece_clear, there, v, height, vz, later, layer_later, *size, d - k)
    around = Growth(wide.start_m + radius + rho, wide.rate_m_s, wide.gain_m_s2)
    around_later = Growth(later.start_m + radius + rho, later.rate_m_s, later.gain_m_s2)
    layer = Growth(high.start_m + half + rho, high.rate_m_s, high.gain_m_s2)
    above_later = Growth(layer_later.start_m + half + rho, layer_later.rate_m_s, high.gain_m_s2)
    named = {"start": around.start_m, "rate": around.rate_m_s, "gain": around.gain_m_s2}
    c.lemma("permit_beside_stays_so_on_the_tail", s=s, v=v, d=d, k=k, **named)
    grown = c.use(growth_after, around, k)
    c.congruence(beside_during, (there, v, grown, d - k), (there, v, around_later, d - k))
    named = {"start": layer.start_m, "rate": layer.rate_m_s, "gain": layer.gain_m_s2}
    for z, w, h in ((sz, vz, height), (0 - sz, 0 - vz, 0 - height)):
        c.lemma("permit_above_stays_so_on_the_tail", sz=z, vz=w, d=d, k=k, **named)
        grown = c.use(growth_after, layer, k)
        c.congruence(above_during, (z + k * w, w, grown, d - k), (h, w, above_later, d - k))
    c.show(c.implies(clear, after))
