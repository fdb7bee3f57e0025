"""A disc is refused only if a place of it is farther from the other's centre than the other's radius: the
one that lies straight on from there, in any direction where the centres are the same."""

from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    p = c.vector("p")
    inner, outer, away, share = c.reals("inner outer away share")
    c.premise(inner >= 0)
    c.premise(outer >= 0)
    # away: the length of p; share: what leads inner farther, in lengths of p
    c.premise(c.all_of(away >= 0, away * away == p.x * p.x + p.y * p.y))
    c.premise(c.implies(away > 0, share * away == inner))
    says = c.use(disc_within, p, inner, outer)
    moved = c.when(away > 0, Vec2(share * p.x, share * p.y), Vec2(inner, inner - inner))
    length = moved.x * moved.x + moved.y * moved.y
    c.step(c.implies(away > 0, length == share * share * (away * away)), "a multiple")
    c.step(length == inner * inner, "as far off as the radius")
    there = Vec2(p.x + moved.x, p.y + moved.y)
    far = there.x * there.x + there.y * there.y
    one = share - share + 1
    c.step(c.implies(away > 0, far == (one + share) * (one + share) * (away * away)), "straight on")
    c.step(c.implies(away > 0, far == (away + inner) * (away + inner)), "as far as both together")
    c.step(c.implies(away == 0, c.all_of(p.x == 0, p.y == 0)), "one centre")
    c.step(c.implies(away == 0, far == inner * inner), "as far as the radius")
    c.step(c.implies(c.negation(says), away + inner > outer), "too far")
    c.show(
        c.implies(c.negation(says), c.negation(c.define(motion.in_disc, p, moved, inner, outer)))
    )
