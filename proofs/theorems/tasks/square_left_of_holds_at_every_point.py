"""If the kernel says that a square lies left of a line, every single point of the square does."""

from cratous.core.tasks.coverage_steps import square_left_of
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    a, b, centre = c.vector("a"), c.vector("b"), c.vector("centre")
    half, u, v = c.reals("half u v")
    c.premise(half >= 0)
    c.premise(c.all_of(u >= -1, u <= 1, v >= -1, v <= 1))
    left = c.use(square_left_of, a, b, centre, half)
    at = c.define(geofence.square_point_left_of, a, b, centre, half, u, v)
    c.show(c.implies(left, at))
