"""If the kernel says that a square does not lie left of a line, a corner of the square lies to the
right of it: no square that does is missed."""

from cratous.core.kernel import Vec2
from cratous.core.tasks.coverage_steps import square_left_of
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    a, b, centre = c.vector("a"), c.vector("b"), c.vector("centre")
    half = c.real("half")
    c.premise(half >= 0)
    left = c.use(square_left_of, a, b, centre, half)
    corners = [
        c.define(geofence.square_point_left_of, a, b, centre, half, u, v)
        for u in (-1, 1)
        for v in (-1, 1)
    ]
    c.show(c.implies(c.all_of(*corners), left))
    # of a square with its centre on an axis as a line, only the half on the left is left of it
    origin, east, north = Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)
    for u, v in ((1, -1), (-1, 1)):
        above = c.define(geofence.square_point_left_of, origin, east, origin, 1, u, v)
        c.show(c.same(above, v > 0), "an example: left of the axis to the east is north")
        west = c.define(geofence.square_point_left_of, origin, north, origin, 1, u, v)
        c.show(c.same(west, u < 0), "an example: left of the axis to the north is west")
