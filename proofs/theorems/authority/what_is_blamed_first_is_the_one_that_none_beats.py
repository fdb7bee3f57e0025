"""Of a list of any length, an entry is the one that is said to have broken first exactly if it is in the list, broke by
the instant, and none broke sooner, or as soon and stands before it."""

from typing import Any

from cratous.core.authority.blame import Broke, broke_first
from cratous.proofs.claim import Claim
from cratous.spec.authority.blame import Blamed, Earliest, blamed_step, came_first

AFTER = 2**62


def claim(c: Claim) -> None:
    since, place, at = (c.integer(name) for name in ("since", "place", "at"))
    of, number = c.integer("of"), c.integer("number")
    c.premise(number >= 0)

    def related(broke: Any, blamed: Any) -> Any:
        by_then = c.any_of(broke.since <= at, broke.since == AFTER)
        ranged = c.all_of(broke.since >= -(2**61), broke.since <= AFTER, by_then)
        same = c.all_of(
            c.same(blamed.since, of),
            c.same(blamed.place, number),
            c.same(blamed.earliest, Earliest(*broke)),
        )
        is_it = c.all_of(broke.since == of, broke.place == number)
        absent = c.implies(c.negation(blamed.there), c.same(blamed.beaten, broke.since <= of))
        present = c.implies(blamed.there, broke.since <= of)
        by = c.implies(of <= at, c.all_of(absent, present))
        return c.all_of(ranged, same, by, c.same(is_it, c.define(came_first, blamed, at)))

    c.fold(
        broke_first,
        acc=Broke(c.whole("first"), c.whole("told")),
        model=Blamed(
            c.whole("asked_since"), c.whole("asked_place"), c.boolean("there"), c.boolean("beaten"),
            Earliest(c.whole("meant_first"), c.whole("meant_number")),
        ),
        item=(since, place),
        context=(at,),
        model_start=Blamed(of, number, False, False, Earliest(AFTER, -1)),
        model_step=blamed_step,
        model_finish=lambda blamed: blamed.earliest,
        relation=related,
    )  # fmt: skip
