"""If both aircraft take, at one instant, velocities that repel, each judged against the other flying on,
then at no later instant are they nearer than they would have come; if they converged, at none as near. And
they pass on the side that both chose, or they no longer converge."""

from cratous.core.daa.coordination import repels
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    s, own, other = c.vector("s"), c.vector("own"), c.vector("other")
    new_own, new_other = c.vector("new_own"), c.vector("new_other")
    side = c.integer("side")
    t, nearest = c.reals("t nearest")
    c.premise(c.any_of(side == 1, side == -1))
    c.premise(t >= 0)
    v = Vec2(own.x - other.x, own.y - other.y)
    mine = Vec2(new_own.x - other.x, new_own.y - other.y)
    seen = Vec2(other.x - own.x, other.y - own.y)
    theirs = Vec2(new_other.x - own.x, new_other.y - own.y)
    w = Vec2(new_own.x - new_other.x, new_own.y - new_other.y)
    back = Vec2(0 - s.x, 0 - s.y)
    sv, vv = s.x * v.x + s.y * v.y, v.x * v.x + v.y * v.y
    c.premise(c.implies(sv < 0, nearest * vv + sv == 0))
    c.premise(c.implies(sv >= 0, nearest == 0))
    away = c.all_of(c.use(repels, s, v, mine, side), c.use(repels, back, seen, theirs, side))
    passed = c.define(daa_coordination.on_the_side, s, v, side) >= 0
    turned = c.define(daa_coordination.turned_away, v, w, side) > 0
    parting = s.x * w.x + s.y * w.y >= 0
    c.step(c.implies(c.all_of(away, sv < 0), c.all_of(passed, turned)), "together they turn away")
    c.step(c.implies(c.all_of(away, sv >= 0), parting), "together they part")
    c.opaque(daa_coordination.apart_at)
    c.lemma("daa_coordination_one_repels", s=s, v=v, w=w, side=side, t=t, nearest=nearest)
    before = c.define(daa_coordination.apart_at, s, v, nearest)
    after = c.define(daa_coordination.apart_at, s, w, t)
    c.show(c.implies(c.all_of(away, sv >= 0), after >= before), "no nearer")
    c.show(c.implies(c.all_of(away, sv < 0), after > before), "not as near")
    on_side = c.define(daa_coordination.on_the_side, s, w, side) > 0
    c.show(c.implies(away, c.any_of(on_side, parting)), "on the side, or parting")
