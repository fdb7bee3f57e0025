"""Convergence: a violation while the two converge lasts, horizontally with tau_mod until the closest
approach, vertically until co-altitude; so while both converge well clear stays lost until the
earlier of the two instants."""

from cratous.core.kernel import Vec2
from cratous.core.well_clear import horizontal_violation, layer_violation
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, dthr, zthr, tthr, tcoa, vmod, t = c.reals("sz vz dthr zthr tthr tcoa vmod t")
    for nonnegative in (dthr, zthr, tthr, tcoa, vmod, t):
        c.premise(nonnegative >= 0)
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    now = c.use(horizontal_violation, s, v, dthr, tthr)
    then = c.use(horizontal_violation, Vec2(s.x + t * v.x, s.y + t * v.y), v, dthr, tthr)
    c.show(c.implies(c.all_of(now, t * vv <= 0 - sv), then), "until the closest approach")
    now = c.use(layer_violation, sz, vz, zthr, tcoa, vmod)
    then = c.use(layer_violation, sz + t * vz, vz, zthr, tcoa, vmod)
    before = c.all_of(sz * vz <= 0, t * vz * vz <= 0 - sz * vz)
    c.show(c.implies(c.all_of(now, before), then), "until co-altitude")
