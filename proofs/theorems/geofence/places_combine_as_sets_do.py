"""The least place is the intersection's, the greatest the union's and the negative the complement's,
for the open parts and for the closed parts; layers of altitudes are as they are defined."""

from typing import Any

from cratous.core.geofence import regions
from cratous.proofs.claim import Claim
from cratous.spec import geofence


def claim(c: Claim) -> None:
    one, other = c.integer("one"), c.integer("other")
    alt, floor, ceiling = c.reals("alt floor ceiling")
    for place in (one, other):
        c.premise(c.any_of(place == -1, place == 0, place == 1))
    c.premise(floor <= ceiling)
    open_, closed = geofence.in_open, geofence.in_closed

    def shows(found: object, parts: tuple[object, object], text: str) -> None:
        for part, wanted, name in zip((open_, closed), parts, ("open", "closed"), strict=True):
            c.show(c.same(c.define(part, found), wanted), f"{text}, {name} part")
        c.show(c.any_of(found == -1, found == 0, found == 1), f"{text}, a place")

    def each(combine: Any) -> tuple[object, object]:
        made = [
            c.define(combine, c.define(part, one), c.define(part, other))
            for part in (open_, closed)
        ]
        return made[0], made[1]

    shows(c.use(regions.both_places, one, other), each(geofence.intersection), "intersection")
    shows(c.use(regions.either_place, one, other), each(geofence.union), "union")
    turned = [c.define(geofence.complement, c.define(part, one)) for part in (closed, open_)]
    shows(c.use(regions.outside_place, one), (turned[0], turned[1]), "complement")
    layer = c.use(regions.layer_place, alt, floor, ceiling)
    shows(
        layer,
        (
            c.define(geofence.in_open_layer, alt, floor, ceiling),
            c.define(geofence.in_closed_layer, alt, floor, ceiling),
        ),
        "layer",
    )
    # `other` is what the boundary is against the buffer: -1 nearer, 0 just so near, 1 farther
    near = other < 0, other <= 0
    wide = [
        c.define(geofence.widened, c.define(part, one), so_near)
        for part, so_near in zip((open_, closed), near, strict=True)
    ]
    shows(c.use(regions.widened_place, one, other), (wide[0], wide[1]), "widened")
    narrow = [
        c.define(geofence.narrowed, c.define(part, one), so_near)
        for part, so_near in zip((open_, closed), near[::-1], strict=True)
    ]
    shows(c.use(regions.narrowed_place, one, other), (narrow[0], narrow[1]), "narrowed")
