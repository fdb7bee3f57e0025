"""A point counts as near a straight line exactly when some point of the line is no farther from it than the
width; where the line is a point only, when that is."""

from cratous.core.avoidance.way_ahead import near_line
from cratous.proofs.claim import Claim
from cratous.spec.avoidance import way_ahead


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    width, t, foot = c.reals("width t foot")
    c.premise(width >= 0)
    said = c.use(near_line, p, a, b, width)
    north, east = b.x - a.x, b.y - a.y
    squared = north * north + east * east
    # foot: where the perpendicular from p meets the line
    c.premise(foot * squared == (p.x - a.x) * north + (p.y - a.y) * east)
    off = p.x - a.x - t * north, p.y - a.y - t * east
    cross = north * (p.y - a.y) - east * (p.x - a.x)
    dot = off[0] * north + off[1] * east
    apart = off[0] * off[0] + off[1] * off[1]
    c.step(squared * apart == cross * cross + dot * dot, "Lagrange's identity")
    at_any = c.define(way_ahead.near_line_at, p, a, b, width, t)
    c.show(c.implies(at_any, said), "who is near some point is near the line")
    at_foot = c.define(way_ahead.near_line_at, p, a, b, width, foot)
    c.show(c.implies(said, at_foot), "and who is near the line is near the foot")
