"""If the kernel says that a square does not lie left of a line, a corner of the square lies to the
right of it: no square that does is missed."""

from cratous.core.coverage_steps import square_left_of
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
