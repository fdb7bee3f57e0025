"""A disc is taken to lie in another only if every place that is no farther from its centre than its radius is
no farther from the other's centre than the other's radius: the triangle inequality."""

from cratous.core.geofence.distance import apart_squared
from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    p, o = c.vector("p"), c.vector("o")
    inner, outer = c.reals("inner outer")
    c.premise(inner >= 0)
    c.premise(outer >= 0)
    c.opaque(disc_within, apart_squared, well_clear.within)
    says = c.use(disc_within, p, inner, outer)
    gap, whole = outer - inner, Vec2(p.x + o.x, p.y + o.y)
    c.lemma("permit_disc_within_leaves_a_gap", p=p, inner=inner, outer=outer)
    for q, most in ((p, gap), (o, inner), (whole, outer)):
        c.lemma("permit_within_compares_squares", p=q, most=most)
    here = c.all_of(says, c.define(well_clear.within, o, inner))
    c.lemma("permit_products_of_short_vectors_are_small", when=here, p=p, o=o, a=gap, b=inner)
    squares = {"first": gap * gap, "second": gap * inner, "third": inner * inner}
    c.lemma("permit_square_of_a_sum_is_bounded", when=here, p=p, o=o, **squares)
    c.step(gap * gap + 2 * (gap * inner) + inner * inner == outer * outer, "the outer square")
    within = c.define(well_clear.within, whole, outer)
    c.show(c.implies(here, within), "a place that is off by no more")
    c.show(c.implies(says, c.define(motion.in_disc, p, o, inner, outer)), "every place is in both")
