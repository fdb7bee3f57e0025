"""For every polygon: where a point outside is no farther than a buffer from some point of the region,
it is so from the boundary; and nearer if it is nearer. So the distance to the boundary decides
whether a point is in the widened region."""

from typing import Any

from cratous.core.geofence.distance import boundary_against, edge_against
from cratous.core.geofence.planar import meets_boundary
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.proofs.methods.crossings import share
from cratous.proofs.methods.ends import PARTS, edge_of_leg, located, seen_alike
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, m, d = c.vector("p"), c.vector("m"), c.real("d")
    c.premise(d >= 0)
    c.opaque(*PARTS, edge_against)
    c.opaque(geofence.squared_distance)
    squared = c.define(geofence.squared_distance, p, m)

    def edge(a: Any, b: Any) -> None:
        edge_of_leg(c, p, m, a, b)
        # the parameters that the lemma wants: of the crossing and the feet, and of their edge points
        wx, wy, ux, uy = m.x - p.x, m.y - p.y, b.x - a.x, b.y - a.y
        det = wx * uy - wy * ux
        s = share(c, (a.x - p.x) * uy - (a.y - p.y) * ux, det)
        t = share(c, (a.x - p.x) * wy - (a.y - p.y) * wx, det)
        f, g = (share(c, (v.x - p.x) * wx + (v.y - p.y) * wy, wx * wx + wy * wy) for v in (a, b))
        named: dict[str, Any] = {"s": s, "t": t, "f": f, "g": g}
        for name, v in zip("ijkor", (s - s, s - s + 1, s, f, g), strict=True):
            at = c.define(geofence.along, p, m, v)
            named[name] = share(c, (at.x - a.x) * ux + (at.y - a.y) * uy, ux * ux + uy * uy)
        c.lemma("geofence_contact_puts_the_boundary_as_near", p=p, m=m, a=a, b=b, d=d, **named)

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        from_p, from_m, met, least = state
        apart = seen_alike(c, p, m, (from_p, from_m), (first, last))
        near = c.all_of(
            c.implies(squared <= d * d, least <= 0), c.implies(squared < d * d, least < 0)
        )
        return c.all_of(c.implies(c.negation(met), apart), c.implies(met, near))

    def near(results: list[Any]) -> Any:
        at_p, at_m, _, least = results
        outside = c.all_of(at_p < 0, at_m >= 0)
        within = c.implies(squared <= d * d, least <= 0)
        return c.implies(outside, c.all_of(within, c.implies(squared < d * d, least < 0)))

    closed_chain(
        c,
        [
            located(c, "p", p),
            located(c, "m", m),
            (meets_boundary, c.boolean("met"), (p, m)),
            (boundary_against, c.whole("least"), (p, d)),
        ],
        invariant=invariant,
        edge=edge,
        goal=near,
        text="as near",
    )
