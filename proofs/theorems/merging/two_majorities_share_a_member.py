"""Of any number of members up to 2^30, two majorities share a member; so if no member supports both of two proposals,
at most one of them has a majority."""

from typing import Any

from cratous.core.merging.votes import is_majority, tally, tally_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.merging import votes

MOST = 1 << 30


def claim(c: Claim) -> None:
    for_one, for_other = c.boolean("for_one"), c.boolean("for_other")
    one, other = c.whole("one"), c.whole("other")
    members, shared = c.whole("members"), c.whole("shared")
    count, whole = c.integer("count"), c.integer("of")
    c.premise(c.all_of(count >= 0, count <= MOST, whole >= 0, whole <= MOST))
    is_one = c.use(is_majority, count, whole)
    c.show(
        c.same(is_one, c.define(votes.is_majority, count, whole)), "a majority is its definition"
    )
    has = c.boolean("has")
    more = c.use(tally_step, count, has)
    counted = c.define(votes.counted, count, has, more)
    c.show(c.implies(count < MOST, counted), "one more is its definition")

    def after(state: list[Any]) -> Any:
        _, (b, n, both) = state
        more_both = c.when(c.all_of(for_one, for_other), both + 1, both)
        return (c.use(tally_step, b, for_other), n + 1, more_both)

    def invariant(state: list[Any]) -> Any:
        a, (b, n, both) = state
        return c.all_of(a >= 0, b >= 0, a <= MOST, b <= MOST, both >= 0, a + b <= n + both)

    def goal(results: list[Any]) -> Any:
        a, (b, n, both) = results
        known = c.all_of(n >= 0, n <= MOST)
        two = c.all_of(c.define(votes.is_majority, a, n), c.define(votes.is_majority, b, n))
        return c.implies(c.all_of(known, two), both >= 1)

    along_items(
        c,
        [(tally, one, ())],
        item=Items((for_one,), True, (for_other,)),
        invariant=invariant,
        goal=goal,
        text="shared",
        beside=[Beside((0, 0, 0), (other, members, shared), after)],
    )
