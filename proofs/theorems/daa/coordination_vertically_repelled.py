"""A velocity that repels vertically is, at every later instant, higher to its side than the old one would
have been; so is the pair if both repel, each judged against the other flying on, each to its own side.
Where the old flight was on that side, both are farther apart vertically than it."""

from typing import Any

from cratous.core.daa.coordination import repels_vertically
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    own, other = c.vector("own"), c.vector("other")
    new_own, new_other = c.vector("new_own"), c.vector("new_other")
    sz, own_z, other_z, new_own_z, new_other_z = c.reals("sz own_z other_z new_own_z new_other_z")
    t = c.real("t")
    side = c.integer("side")
    c.premise(c.any_of(side == 1, side == -1))
    c.premise(t > 0)

    def less(a: Vec2, b: Vec2) -> Vec2:
        return Vec2(a.x - b.x, a.y - b.y)

    v, vz = less(own, other), own_z - other_z
    mine = c.use(repels_vertically, v, vz, less(new_own, other), new_own_z - other_z, side)
    theirs = c.use(
        repels_vertically, less(other, own), other_z - own_z, less(new_other, own),
        new_other_z - own_z, 0 - side,
    )  # fmt: skip
    old = c.define(daa_coordination.to_side, side, sz + t * vz)

    def shown(when: Any, rate: Any, name: str) -> None:
        new = c.define(daa_coordination.to_side, side, sz + t * rate)
        c.show(c.implies(when, new > old), name)
        farther = abs(sz + t * rate) > abs(sz + t * vz)
        c.show(c.implies(c.all_of(when, old >= 0), farther), f"{name}: farther apart")

    shown(mine, new_own_z - other_z, "one")
    both = c.all_of(mine, theirs)
    shown(both, new_own_z - new_other_z, "both")
    w = less(new_own, new_other)
    again = c.use(repels_vertically, v, vz, w, new_own_z - new_other_z, side)
    c.show(c.implies(both, again), "both together repel as one does")
