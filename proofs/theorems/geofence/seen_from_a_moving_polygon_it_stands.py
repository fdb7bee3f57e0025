"""A leg meets a moving edge at an instant exactly where, seen from the moving polygon, it meets the standing edge; its points
have the same ray crossings and the same distances there."""

from cratous.core.geofence.motion import seen_from
from cratous.core.geofence.planar import crosses_ray
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    v = c.vector("v")
    begin, end, s, t = c.reals("begin end s t")
    at = begin + s * (end - begin)
    first, last = c.use(seen_from, p, v, begin), c.use(seen_from, q, v, end)
    movement = geofence.Movement(geofence.Point(v.x, v.y), begin, end)
    moving = c.define(geofence.moved_edge_met, p, q, a, b, movement, s, t)
    standing = c.define(geofence.common_point, first, last, a, b, s, t)
    c.show(c.same(moving, standing), "a common point")
    here = Vec2(*c.define(geofence.along, p, q, s))
    there = Vec2(*c.define(geofence.along, first, last, s))
    c.show(c.same(c.define(geofence.moved, there, v, at), here), "the leg, seen from there")
    gone = [Vec2(*c.define(geofence.moved, one, v, at)) for one in (a, b)]
    c.show(
        c.same(
            c.define(geofence.squared_distance, here, gone[0]),
            c.define(geofence.squared_distance, there, a),
        ),
        "distances",
    )
    c.show(
        c.same(c.use(crosses_ray, here, *gone), c.use(crosses_ray, there, a, b)),
        "ray crossings",
    )
