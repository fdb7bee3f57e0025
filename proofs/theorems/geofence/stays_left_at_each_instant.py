"""A moving vertex is taken to stay left of a line exactly when there is no instant of the span at which it is right of it; where
it does not stay, it is right of it at the beginning or at the end."""

from typing import Any

from cratous.core.geofence.motion import stays_left
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    a, b, m, v = c.vector("a"), c.vector("b"), c.vector("m"), c.vector("v")
    begin, end, t = c.reals("begin end t")
    c.premise(c.all_of(begin <= t, t <= end))
    stays = c.use(stays_left, a, b, m, v, begin, end)

    def turned(at: Any) -> Any:
        return c.define(geofence.turn, a, b, c.define(geofence.moved, m, v, at))

    c.step(
        (end - begin) * turned(t) == (end - t) * turned(begin) + (t - begin) * turned(end),
        "between the ends",
    )
    right = [c.define(geofence.right_at, a, b, m, v, begin, end, at) for at in (t, begin, end)]
    c.show(c.implies(stays, c.negation(right[0])), "at each instant")
    c.show(c.implies(c.negation(stays), c.any_of(right[1], right[2])), "a witness")
