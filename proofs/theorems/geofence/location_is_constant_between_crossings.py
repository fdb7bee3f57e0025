"""For every polygon: between two neighbouring parameters of a leg's crossings with its edges, the
location of the leg's points does not change."""

from typing import Any

from cratous.core.geofence.passages import crossing, foot
from cratous.core.geofence.planar import Seen, crosses_ray, locate, on_segment, segments_meet
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim
from cratous.proofs.methods.chains import closed_chain
from cratous.proofs.methods.crossings import crossing_named, feet_named, undisturbed
from cratous.proofs.methods.sweeping import swept
from cratous.spec import geofence


def claim(c: Claim) -> None:
    p, q = c.vector("p"), c.vector("q")
    t, u, low, high = c.reals("t u low high")
    c.premise(low < t)
    c.premise(t <= u)
    c.premise(u < high)
    here, there = (Vec2(*c.define(geofence.along, p, q, s)) for s in (t, u))
    c.opaque(segments_meet, on_segment, crosses_ray, swept, crossing, foot)

    def edge(a: Any, b: Any) -> None:
        c.lemma("geofence_crossings_telescope_along_an_edge", p=here, q=there, a=a, b=b)
        c.lemma("geofence_an_end_on_an_edge_is_a_contact", p=here, q=there, a=a, b=b)
        undisturbed(c, p, q, a, b, low, high)
        # parameters that the lemma wants: of the leg's feet, and of the part's own crossing and feet
        i, j, s, r, f, g = c.reals("i j s r f g")
        feet_named(c, p, q, a, b, i, j)
        crossing_named(c, here, there, a, b, s, r)
        feet_named(c, here, there, a, b, f, g)
        leg: dict[str, Any] = {"p": p, "q": q, "t": t, "u": u, "low": low, "high": high}
        named: dict[str, Any] = {"i": i, "j": j, "s": s, "r": r, "f": f, "g": g}
        c.lemma("geofence_contact_is_shared_between_crossings", a=a, b=b, **leg, **named)

    def invariant(state: list[Any], first: Any, last: Any) -> Any:
        one, other = state
        differ = c.negation(c.same(one.odd, other.odd))
        ends = c.same(c.define(swept, first, here, there), c.define(swept, last, here, there))
        same = c.any_of(one.on, c.negation(c.same(differ, ends)))
        return c.all_of(c.same(one.on, other.on), same)

    closed_chain(
        c,
        [
            (locate, Seen(c.boolean("t_on"), c.boolean("t_odd")), (here,)),
            (locate, Seen(c.boolean("u_on"), c.boolean("u_odd")), (there,)),
        ],
        invariant=invariant,
        edge=edge,
        goal=lambda results: c.same(*results),
        text="same location",
    )
