"""Of a list of any length, an entry is the one that is said to have command exactly if it is in the list, told by the
instant, and none that is told by then is later, or as late and after it."""

from typing import Any

from cratous.core.authority.blame import Stood, stood_at
from cratous.proofs.claim import Claim
from cratous.spec.authority.blame import Asked, Latest, asked_step, stands

BEFORE = -(2**62)


def claim(c: Claim) -> None:
    time, place, at = (c.integer(name) for name in ("time", "place", "at"))
    of, number = c.integer("of"), c.integer("number")
    c.premise(number >= 0)

    def related(stood: Any, asked: Any) -> Any:
        told = c.any_of(stood.since <= at, stood.since == BEFORE)
        ranged = c.all_of(stood.since >= BEFORE, stood.since <= 2**61, told)
        same = c.all_of(
            c.same(asked.time, of),
            c.same(asked.place, number),
            c.same(asked.latest, Latest(*stood)),
        )
        is_it = c.all_of(stood.since == of, stood.place == number)
        later = c.same(asked.later, stood.since > of)
        return c.all_of(ranged, same, later, c.same(is_it, c.define(stands, asked, at)))

    c.fold(
        stood_at,
        acc=Stood(c.whole("latest"), c.whole("told")),
        model=Asked(
            c.whole("asked_time"), c.whole("asked_place"), c.boolean("there"), c.boolean("later"),
            c.boolean("after"), Latest(c.whole("meant_latest"), c.whole("meant_number")),
        ),
        item=(time, place),
        context=(at,),
        model_start=Asked(of, number, False, False, False, Latest(BEFORE, -1)),
        model_step=asked_step,
        model_finish=lambda asked: asked.latest,
        relation=related,
    )  # fmt: skip
