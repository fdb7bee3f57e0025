"""A step that repels, and the piece after it, keep what the flight before the step kept: a distance that the old
piece, flown on from the step, would keep at all later instants is kept by them at all later instants. One
step of a way, which is made of such steps."""

from cratous.core.daa.coordination import repels
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    s, before, at, after = (c.vector(n) for n in ("s", "before", "at", "after"))
    side = c.integer("side")
    t, nearest, kept = c.reals("t nearest kept")
    c.premise(c.any_of(side == 1, side == -1))
    c.premise(t >= 0)
    sv = s.x * before.x + s.y * before.y
    vv = before.x * before.x + before.y * before.y
    c.premise(c.implies(sv < 0, nearest * vv + sv == 0))
    c.premise(c.implies(sv >= 0, nearest == 0))
    c.premise(c.define(daa_coordination.apart_at, s, before, nearest) >= kept)
    c.opaque(repels)
    pairs = ((before, at), (at, after), (before, after))
    way = c.all_of(*[c.use(repels, s, v, w, side) for v, w in pairs])
    for name, w in (("straight on from the step", at), ("the next piece", after)):
        c.lemma("daa_coordination_one_repels", s=s, v=before, w=w, side=side, t=t, nearest=nearest)
        c.show(c.implies(way, c.define(daa_coordination.apart_at, s, w, t) >= kept), name)
