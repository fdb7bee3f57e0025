"""What is left of a piece that is taken to be clear of an intruder, after any part of it has been flown, is
taken to be clear of it too, by the tube as it has grown until then."""

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import (
    Tube,
    above_during,
    beside_during,
    growth_after,
    piece_clear,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state
from cratous.proofs.methods.meetings import about, any_margins, any_tube, growth_by_name
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    tube, margins = any_tube(c), any_margins(c)
    d, k = c.reals("d k")
    c.premise(c.all_of(k >= 0, k <= d))
    c.opaque(above_during, beside_during, motion.levelled_at)
    clear = c.use(piece_clear, s, v, sz, vz, tube, margins, d)
    there, height = Vec2(s.x + k * v.x, s.y + k * v.y), sz + k * vz
    later = Tube(*[c.use(growth_after, growth, k) for growth in tube])
    after = c.use(piece_clear, there, v, height, vz, later, margins, d - k)
    around, layer = about(tube, margins)
    around_later, above_later = about(later, margins)
    named = growth_by_name(around)
    c.lemma("permit_beside_stays_so_on_the_tail", s=s, v=v, d=d, k=k, **named)
    grown = c.use(growth_after, around, k)
    c.congruence(beside_during, (there, v, grown, d - k), (there, v, around_later, d - k))
    named = growth_by_name(layer)
    for z, w, h in ((sz, vz, height), (0 - sz, 0 - vz, 0 - height)):
        c.lemma("permit_above_stays_so_on_the_tail", sz=z, vz=w, d=d, k=k, **named)
        grown = c.use(growth_after, layer, k)
        c.congruence(above_during, (z + k * w, w, grown, d - k), (h, w, above_later, d - k))
    c.show(c.implies(clear, after))
