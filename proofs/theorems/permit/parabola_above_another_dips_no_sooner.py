"""If a parabola reaches zero or less in the last part of a time and another one is no higher at the ends of this part
and at the vertex, the other one does so in the whole time."""

from cratous.core.well_clear import dips_to_zero
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    a, b, k, p, q, r = c.reals("a b c p q r")
    h, gone, vertex = c.reals("h gone vertex")
    rest = h - gone
    c.premise(c.all_of(gone >= 0, gone <= h))
    c.premise(c.implies(p > 0, 2 * p * vertex + q == 0))
    c.opaque(dips_to_zero)
    whole = c.use(dips_to_zero, a, b, k, h)
    part = c.use(dips_to_zero, p, q, r, rest)
    c.lemma("permit_parabola_of_any_sign_has_a_witness", a=p, b=q, c=r, h=rest, vertex=vertex)
    for t in (h - h, rest, vertex):
        inside = c.all_of(t >= 0, t <= rest)
        lower = c.define(well_clear.parabola, a, b, k, gone + t)
        c.premise(c.implies(inside, lower <= c.define(well_clear.parabola, p, q, r, t)))
        c.lemma(
            "permit_parabola_of_any_sign_misses_no_instant",
            when=inside, a=a, b=b, c=k, h=h, t=gone + t,
        )  # fmt: skip
    c.show(c.implies(part, whole))
