"""A waypoint is one to make for exactly when it is farther than three turn radii and some way flown in the
direction that leads on from it brings the vehicle nearer to it."""

from cratous.core.avoidance.way_ahead import makes_for
from cratous.proofs.claim import Claim
from cratous.spec.avoidance import way_ahead


def claim(c: Claim) -> None:
    p, goal, beyond = c.vector("p"), c.vector("goal"), c.vector("beyond")
    radius, s, nearest = c.reals("radius s nearest")
    c.premise(radius >= 0)
    north, east = beyond.x - goal.x, beyond.y - goal.y
    squared = north * north + east * east
    forward = (goal.x - p.x) * north + (goal.y - p.y) * east
    # nearest: how far to fly in that direction to be nearest to the goal
    c.premise(nearest * squared == forward)
    said = c.use(makes_for, p, goal, beyond, radius)
    at_any = c.define(way_ahead.makes_for_at, p, goal, beyond, radius, s)
    c.step(squared >= 0, "a square")
    c.show(c.implies(at_any, said), "some way brings it nearer")
    c.step(c.implies(forward > 0, squared > 0), "a leg that leads somewhere has a length")
    c.step(c.implies(forward > 0, nearest > 0), "ahead")
    at_nearest = c.define(way_ahead.makes_for_at, p, goal, beyond, radius, nearest)
    c.show(c.implies(said, at_nearest), "else none does")
