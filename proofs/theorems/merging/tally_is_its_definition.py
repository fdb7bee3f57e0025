"""The kernel's count of members equals counting them one by one, for any number of members, up to a count of 2^30."""

from typing import Any

from cratous.core.merging.votes import tally
from cratous.proofs.claim import Claim
from cratous.spec.merging import votes


def claim(c: Claim) -> None:
    def alike(count: Any, number: Any) -> Any:
        return c.all_of(count == number, number >= 0, number <= votes.MOST)

    c.fold(
        tally,
        acc=c.whole("count"),
        model=c.whole("number"),
        item=(c.boolean("has"),),
        context=(),
        model_start=0,
        model_step=votes.number_with,
        relation=alike,
    )
