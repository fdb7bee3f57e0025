"""Where vehicle and intruder may have places at which the cylinder is entered, the reference is no farther from
the prediction than the cylinder, rho and the tube together, horizontally and in altitude."""

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import Growth, Tube, reach_after
from cratous.core.permit.tubes import disc_within
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state
from cratous.proofs.methods.meetings import about, any_margins, any_offs
from cratous.spec import well_clear
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    margins, offs, t = any_margins(c), any_offs(c), c.real("t")
    wide, high = (Growth(*c.reals(f"{n}_start {n}_rate {n}_gain")) for n in ("wide", "high"))
    tube = Tube(wide, high)
    radius, _, rho = margins
    own, other = offs
    c.opaque(disc_within, well_clear.within)
    hit = c.define(motion.hit_at, s, v, sz, vz, offs, tube, margins, t)
    around, layer = about(tube, margins)
    far = c.use(reach_after, wide, t)
    c.step(c.implies(hit, far >= 0), "a tube")
    # from where both are, back to the reference, and back to the prediction
    there = Vec2(s.x + t * v.x + own.x - other.x, s.y + t * v.y + own.y - other.y)
    back, back_other = Vec2(0 - own.x, 0 - own.y), Vec2(other.x, other.y)
    near = Vec2(there.x + back.x, there.y + back.y)
    off, outer = Vec2(own.x, own.y), radius + rho
    c.lemma("permit_within_turns_scales_and_grows", p=off, most=rho, more=rho, times=rho)
    for p, o, inner, wider in (
        (back, there, radius, outer),
        (back_other, near, outer, outer + far),
    ):
        c.lemma("permit_disc_within_leaves_a_gap", p=p, inner=inner, outer=wider)
        c.lemma(
            "permit_disc_within_holds_every_place", when=hit, p=p, o=o, inner=inner, outer=wider
        )
    c.show(c.implies(hit, c.define(motion.reached_at, s, v, around, t)), "horizontally")
    levels = [c.define(motion.levelled_at, z, w, layer, t) for z, w in ((sz, vz), (0 - sz, 0 - vz))]
    c.show(c.implies(hit, c.all_of(*levels)), "in altitude")
