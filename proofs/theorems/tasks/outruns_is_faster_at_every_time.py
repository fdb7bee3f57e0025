"""Who is said to outrun what moves gets farther than it in every time; and who is not, in none."""

from cratous.core.tasks.stations import outruns
from cratous.proofs.claim import Claim
from cratous.spec import stations


def claim(c: Claim) -> None:
    velocity = c.vector("velocity")
    speed, t = c.reals("speed t")
    c.premise(speed >= 0)
    c.premise(t > 0)
    said = c.use(outruns, velocity, speed)
    farther = c.define(stations.outruns_in, velocity, speed, t)
    c.show(c.implies(said, farther), "farther in every time")
    c.show(c.implies(farther, said), "and if it is in one time, it is said")
