"""A disc is refused only if a place of it is farther from the other's centre than the other's radius: the
one that lies straight on from there, in any direction where the centres are the same."""

from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    p, ahead = c.vector("p"), c.vector("ahead")
    inner, outer, away = c.reals("inner outer away")
    c.premise(inner >= 0)
    c.premise(outer >= 0)
    # ahead: the direction of p, of length 1; any where p is 0. away: the length of p
    c.premise(ahead.x * ahead.x + ahead.y * ahead.y == 1)
    c.premise(away >= 0)
    c.premise(c.all_of(p.x == away * ahead.x, p.y == away * ahead.y))
    says = c.use(disc_within, p, inner, outer)
    moved = Vec2(inner * ahead.x, inner * ahead.y)
    c.step(moved.x * moved.x + moved.y * moved.y == inner * inner, "as far off as the radius")
    there = Vec2(p.x + moved.x, p.y + moved.y)
    far = there.x * there.x + there.y * there.y
    c.step(far == (away + inner) * (away + inner), "as far as both together")
    c.step(p.x * p.x + p.y * p.y == away * away, "the length")
    c.step(c.implies(c.negation(says), away + inner > outer), "too far")
    c.show(
        c.implies(c.negation(says), c.negation(c.define(motion.in_disc, p, moved, inner, outer)))
    )
