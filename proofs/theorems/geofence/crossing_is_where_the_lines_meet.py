"""Two lines that are not parallel meet at one point, at the parameter that the crossing kernel gives;
parallels have no crossing."""

from cratous.core.geofence.passages import cross, crossing
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    s, t, here, there = c.reals("s t here there")
    at = c.use(crossing, p, q, a, b)
    c.show(c.same(at.den, c.use(cross, p, q, a, b)), "no crossing of parallels")
    meet = c.define(geofence.lines_meet_at, p, q, a, b, s, t)
    c.show(c.implies(meet, s * at.den == at.num), "they meet nowhere else")
    # the parameters of the crossing on both lines, named by the equations that define them
    c.premise(here * at.den == at.num)
    back = c.use(crossing, a, b, p, q)
    c.premise(there * back.den == back.num)
    crossed = c.define(geofence.lines_meet_at, p, q, a, b, here, there)
    c.show(c.implies(at.den != 0, crossed), "they meet there")
