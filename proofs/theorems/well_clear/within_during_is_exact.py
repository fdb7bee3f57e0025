"""Two straight courses come within a distance during [0, h] for the kernel exactly when they do at
some instant of it: no instant is missed, and one can be named, 0, h or the closest approach."""

from cratous.core.well_clear import within_during
from cratous.proofs.claim import Claim
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    radius, h, t, closest = c.reals("radius h t closest")
    c.premise(radius >= 0)
    c.premise(t >= 0)
    c.premise(t <= h)
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    c.premise(c.implies(vv > 0, vv * closest + sv == 0))
    near = c.use(within_during, s, v, radius, h)

    def there(time: object) -> object:
        return c.define(well_clear.within_at, s, v, radius, time)

    c.show(c.implies(there(t), near), "no instant is missed")
    inner = c.all_of(closest >= 0, closest <= h, there(closest))
    c.show(c.implies(near, c.any_of(there(h - h), there(h), inner)), "one can be named")
