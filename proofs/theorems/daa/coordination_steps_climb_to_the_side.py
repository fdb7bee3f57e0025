"""Of a step that repels vertically, from the piece before it and on to the piece after it, the relative climb
rate grows to the side, from piece to step to piece: at every later instant an intruder that flies on is
farther to the other side. One step of a way, which is made of such steps."""

from typing import Any

from cratous.core.daa.coordination import repels_vertically
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    before, at, after = c.vector("before"), c.vector("at"), c.vector("after")
    before_z, at_z, after_z = c.reals("before_z at_z after_z")
    sz, t = c.reals("sz t")
    side = c.integer("side")
    c.premise(c.any_of(side == 1, side == -1))
    c.premise(t > 0)
    pairs = (
        (before, before_z, at, at_z),
        (at, at_z, after, after_z),
        (before, before_z, after, after_z),
    )
    way = c.all_of(*[c.use(repels_vertically, *pair, side) for pair in pairs])

    def height(rate: Any) -> Any:
        return c.define(daa_coordination.to_side, side, sz + t * rate)

    c.show(c.implies(way, height(at_z) > height(before_z)), "straight on from the step")
    c.show(c.implies(way, height(after_z) > height(at_z)), "the next piece")
