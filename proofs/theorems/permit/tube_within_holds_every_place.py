"""Where a new tube is taken to lie in the old one, every place that the intruder may have by the new one it
may have by the old one, now and at every instant after."""

from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import growth_after
from cratous.core.permit.tubes import disc_within, tube_within
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v, o = c.vector("s"), c.vector("v"), c.vector("o")
    new = motion.Growth(*c.reals("start rate gain"))
    old = motion.Growth(*c.reals("old_start old_rate old_gain"))
    age, t = c.reals("age t")
    for growth in (new, old):
        c.premise(c.all_of(growth.start_m >= 0, growth.rate_m_s >= 0, growth.gain_m_s2 >= 0))
    c.premise(c.all_of(age >= 0, t >= 0))
    c.opaque(disc_within, well_clear.within)
    says = c.use(tube_within, s, v, new, old, age)
    now = c.use(growth_after, old, age)
    for q, small, large in ((s, new.start_m, now.start_m), (v, new.rate_m_s, now.rate_m_s)):
        c.lemma("permit_disc_within_leaves_a_gap", p=q, inner=small, outer=large)
    faster, wider = now.rate_m_s - new.rate_m_s, now.start_m - new.start_m
    most, then = c.define(motion.reach, new, t), c.define(motion.reach, old, age + t)
    c.step(c.all_of(t * new.rate_m_s >= 0, t * t * new.gain_m_s2 >= 0), "no growth below 0")
    c.step(most >= 0, "nor the new radius")
    c.step(c.implies(says, c.all_of(faster >= 0, wider >= 0)), "no radius is less")
    c.step(c.implies(says, t * faster >= 0), "nor becomes so")
    within = c.define(well_clear.within, o, most)
    here = c.all_of(says, within)
    # off by the difference of the speeds, then by that of the places
    c.lemma(
        "permit_within_turns_scales_and_grows", when=here, p=v, most=faster, more=faster, times=t
    )
    moved = Vec2(t * v.x, t * v.y)
    near = Vec2(moved.x + o.x, moved.y + o.y)
    outer = most + t * faster
    for p, q, inner, large in ((moved, o, most, outer), (s, near, outer, outer + wider)):
        c.lemma("permit_disc_within_leaves_a_gap", p=p, inner=inner, outer=large)
        c.lemma(
            "permit_disc_within_holds_every_place", when=here, p=p, o=q, inner=inner, outer=large
        )
    whole = outer + wider
    left = (old.gain_m_s2 - new.gain_m_s2) * (t * t)
    c.step(then - whole == left, "what is left of the old radius")
    c.step(c.implies(says, left >= 0), "is not less than nothing")
    there = Vec2(s.x + near.x, s.y + near.y)
    c.lemma(
        "permit_within_turns_scales_and_grows", when=here, p=there, most=whole, more=then, times=t
    )
    c.show(c.implies(says, c.define(motion.in_tube_at, s, v, o, new, old, age, t)))
