"""What is said to have broken first is the earliest of all that broke by an instant, for every number of them."""

from typing import Any

from cratous.core.authority.blame import Broke, broke_first, broke_step
from cratous.proofs.claim import Claim
from cratous.spec.authority.blame import Earliest
from cratous.spec.authority.blame import broke_step as earliest_step


def claim(c: Claim) -> None:
    since, place, at = (c.integer(name) for name in ("since", "place", "at"))
    before = Broke(c.integer("earlier"), c.integer("told"))
    after = c.use(broke_step, before, since, place, at)
    c.show(after.since <= before.since, "what broke first is never later than before")
    c.show(c.implies(since <= at, after.since <= since), "nothing that broke by then is earlier")
    later = c.implies(since > at, c.same(after, before))
    c.show(later, "what breaks after the instant is not to blame")

    def related(broke: Any, earliest: Any) -> Any:
        ranged = c.all_of(broke.since >= -(2**61), broke.since <= 2**62)
        return c.all_of(
            ranged, c.same(broke.since, earliest.since), c.same(broke.place, earliest.place)
        )

    c.fold(
        broke_first,
        acc=Broke(c.whole("first"), c.whole("number")),
        model=Earliest(c.whole("meant_first"), c.whole("meant_number")),
        item=(since, place),
        context=(at,),
        model_start=Earliest(2**62, -1),
        model_step=earliest_step,
        relation=related,
    )
