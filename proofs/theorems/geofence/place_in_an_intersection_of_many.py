"""For any number of regions, the fold gives the place in their intersection: its open part takes the open
parts of the regions, and its closed part the closed ones."""

from typing import Any

from cratous.core.geofence.regions import place_in_all
from cratous.proofs.claim import Claim
from cratous.spec.geofence import Parts, in_closed, in_open, intersection_step, place_of


def model_step(parts: Any, place: Any) -> Any:
    return intersection_step(parts, in_open(place), in_closed(place))


def claim(c: Claim) -> None:
    place = c.integer("place")
    c.premise(c.any_of(place == -1, place == 0, place == 1))

    def related(found: Any, parts: Any) -> Any:
        word = c.when(parts.open, 1, c.when(parts.closed, 0, -1))
        return c.all_of(c.same(found, word), c.implies(parts.open, parts.closed))

    c.fold(
        place_in_all,
        acc=c.whole("found"),
        model=Parts(c.boolean("open"), c.boolean("closed")),
        item=(place,),
        context=(),
        model_start=Parts(True, True),
        model_step=model_step,
        model_finish=place_of,
        relation=related,
    )
