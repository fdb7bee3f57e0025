"""The orientation kernel is the signed area that the sides of the triangle sweep, twice, and the
determinant of the turn from a over b to c; swapping two points turns its sign, and it does not
change when the three points are moved together."""

from cratous.core.geofence.planar import orient
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    a, b, k, d = c.vector("a"), c.vector("b"), c.vector("c"), c.vector("d")
    area = c.use(orient, a, b, k)
    swept = c.define(geofence.swept_by_triangle, a, b, k)
    c.show(c.same(area, swept), "it is the area of the triangle")
    c.show(c.same(area, c.define(geofence.turn, a, b, k)), "it is the determinant")
    c.show(c.same(area, 0 - c.use(orient, b, a, k)), "swapping two points turns the sign")
    moved = [Vec2(p.x + d.x, p.y + d.y) for p in (a, b, k)]
    c.show(c.same(area, c.use(orient, *moved)), "moving all three changes nothing")
