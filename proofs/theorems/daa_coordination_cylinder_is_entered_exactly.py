"""The kernel that says whether two aircraft will be in one cylinder misses no later instant, and where it
says so, there is one: the begin or the end of the time at one height, or the closest approach."""

from typing import Any

from cratous.core.daa_coordination import enters_cylinder
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import daa_coordination


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    sz, vz, radius, half, t = c.reals("sz vz radius half t")
    begin, end, closest = c.reals("begin end closest")
    c.premise(radius >= 0)
    c.premise(half >= 0)
    c.premise(t >= 0)
    c.premise(c.negation(vz == 0))
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    c.premise(c.implies(vv > 0, vv * closest + sv == 0))
    # when the heights are within half of each other
    c.premise(c.implies(vz > 0, c.all_of(begin * vz == 0 - half - sz, end * vz == half - sz)))
    c.premise(c.implies(vz < 0, c.all_of(begin * vz == half - sz, end * vz == 0 - half - sz)))
    found = c.use(enters_cylinder, s, v, sz, vz, radius, half)

    def there(time: Any) -> Any:
        inside = c.define(daa_coordination.in_cylinder_at, s, v, sz, vz, radius, half, time)
        return c.all_of(time >= 0, inside)

    c.show(c.implies(there(t), found), "no instant is missed")
    named = c.any_of(there(t - t), there(begin), there(end), there(closest))
    c.show(c.implies(found, named), "one can be named")
    # examples: in it now; past it before the heights meet
    at, on = Vec2(0, 0), Vec2(10, 0)
    c.show(c.use(enters_cylinder, at, Vec2(0, 0), 0, 1, 5, 1), "an example: now")
    c.show(c.negation(c.use(enters_cylinder, at, on, -10, 1, 20, 1)), "an example: too late")
