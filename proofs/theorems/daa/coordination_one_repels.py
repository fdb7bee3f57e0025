"""If one aircraft takes a velocity that repels and the other flies on, then at no later instant are they
nearer than they would have come; and if they converged, at none as near. They pass on the chosen side. In
general, who parts is no nearer than now, and who turns away from a side on which the other is passed comes
less near."""

from cratous.core.daa.coordination import horizontal_side, repels
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec.daa import coordination as daa_coordination


def claim(c: Claim) -> None:
    s, v, w = c.vector("s"), c.vector("v"), c.vector("w")
    side = c.integer("side")
    t, nearest = c.reals("t nearest")
    c.premise(c.any_of(side == 1, side == -1))
    c.premise(t >= 0)
    sv, vv = s.x * v.x + s.y * v.y, v.x * v.x + v.y * v.y
    # the instant at which they would have been nearest
    c.premise(c.implies(sv < 0, nearest * vv + sv == 0))
    c.premise(c.implies(sv >= 0, nearest == 0))
    # n: where they would have been then; d: the way from there to where they are after t
    n = Vec2(s.x + nearest * v.x, s.y + nearest * v.y)
    d = Vec2(t * w.x - nearest * v.x, t * w.y - nearest * v.y)
    along, ahead = n.x * w.x + n.y * w.y, n.x * d.x + n.y * d.y
    before = c.define(daa_coordination.apart_at, s, v, nearest)
    after = c.define(daa_coordination.apart_at, s, w, t)
    apart = c.negation(c.all_of(d.x == 0, d.y == 0))
    c.step(c.implies(c.all_of(ahead >= 0, apart), after > before), "farther by the way from there")
    square = n.x * v.x + n.y * v.y
    across, turn = v.x * s.y - v.y * s.x, v.x * w.y - v.y * w.x
    c.step(c.implies(c.all_of(vv > 0, nearest > 0, c.negation(turn == 0)), apart), "elsewhere")
    products = square * (v.x * w.x + v.y * w.y) + across * turn
    c.step(along * vv == products, "both products")
    c.step(c.implies(square == 0, along * vv == across * turn), "at right angles one")
    c.step(c.implies(c.all_of(vv > 0, along * vv >= 0), along >= 0), "a square has no sign")
    c.step(c.implies(c.all_of(square == 0, along >= 0), ahead >= 0), "on along w leads away from n")
    passed = c.define(daa_coordination.on_the_side, s, v, side)
    turned = c.define(daa_coordination.turned_away, v, w, side)
    turns = c.all_of(sv < 0, passed >= 0, turned > 0)
    c.step(c.implies(turns, c.all_of(vv > 0, nearest > 0)), "the closest approach is to come")
    right = c.all_of(passed == across, turned == turn)
    left = c.all_of(passed + across == 0, turned + turn == 0)
    c.step(c.any_of(right, left), "a side is a sign")
    c.step(c.implies(turns, across * turn >= 0), "to one side")
    c.step(c.implies(turns, square == 0), "n is at right angles to v")
    c.step(c.implies(turns, along * vv >= 0), "their sign")
    c.step(c.implies(turns, along >= 0), "w does not lead back across n")
    c.step(c.implies(turns, c.negation(turn == 0)), "a turn")
    c.step(c.implies(turns, apart), "so elsewhere")
    c.step(c.implies(turns, ahead >= 0), "and away")
    c.show(c.implies(turns, after > before), "who turns away comes less near")
    parts = s.x * w.x + s.y * w.y >= 0
    c.show(c.implies(c.all_of(sv >= 0, parts), after >= before), "who parts is no nearer")
    away = c.use(repels, s, v, w, side)
    c.show(c.implies(away, c.define(daa_coordination.on_the_side, s, w, side) > 0), "on the side")
    c.step(c.implies(c.all_of(away, sv < 0), turns), "who repels turns away")
    c.step(c.implies(c.all_of(away, sv >= 0), parts), "or parts")
    c.show(c.implies(c.all_of(away, sv >= 0), after >= before), "no nearer")
    c.show(c.implies(c.all_of(away, sv < 0), after > before), "not as near")
    same = c.use(horizontal_side, s, w) == c.use(horizontal_side, s, v)
    chosen = c.use(horizontal_side, s, v) == side
    c.show(c.implies(c.all_of(away, chosen), same), "the side stays chosen")
