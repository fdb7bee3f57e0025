"""Who commands at an instant is who was told latest of all that was told by then, for every number of changes."""

from typing import Any

from cratous.core.authority.blame import Stood, stood_at, stood_step
from cratous.proofs.claim import Claim
from cratous.spec.authority.blame import Latest
from cratous.spec.authority.blame import stood_step as latest_step


def claim(c: Claim) -> None:
    time, place, at = (c.integer(name) for name in ("time", "place", "at"))
    before = Stood(c.integer("since"), c.integer("told"))
    after = c.use(stood_step, before, time, place, at)
    c.show(after.since >= before.since, "what stands is never older than before")
    c.show(c.implies(time <= at, after.since >= time), "nothing told by then is later than it")
    later = c.implies(time > at, c.same(after, before))
    c.show(later, "what is told after the instant makes no difference")

    def related(stood: Any, latest: Any) -> Any:
        ranged = c.all_of(stood.since >= -(2**62), stood.since <= 2**61)
        return c.all_of(
            ranged, c.same(stood.since, latest.since), c.same(stood.place, latest.place)
        )

    c.fold(
        stood_at,
        acc=Stood(c.whole("latest"), c.whole("number")),
        model=Latest(c.whole("meant_latest"), c.whole("meant_number")),
        item=(time, place),
        context=(at,),
        model_start=Latest(-(2**62), -1),
        model_step=latest_step,
        relation=related,
    )
