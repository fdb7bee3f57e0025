"""A waypoint counts as good as reached exactly when, flown straight to it, it is reached before the time is
over."""

from cratous.core.avoidance.way_ahead import there_within
from cratous.proofs.claim import Claim
from cratous.spec.avoidance import way_ahead


def claim(c: Claim) -> None:
    p, goal = c.vector("p"), c.vector("goal")
    speed, within, t, arrival = c.reals("speed within t arrival")
    c.premise(c.all_of(speed > 0, within >= 0))
    north, east = goal.x - p.x, goal.y - p.y
    way = speed * arrival  # arrival: when the whole distance has been flown
    c.premise(c.all_of(arrival >= 0, way * way == north * north + east * east))
    said = c.use(there_within, p, goal, speed, within)
    at_any = c.define(way_ahead.there_at, p, goal, speed, within, t)
    c.show(c.implies(at_any, said), "reached at some instant")
    at_arrival = c.define(way_ahead.there_at, p, goal, speed, within, arrival)
    c.show(c.implies(said, at_arrival), "else at none")
