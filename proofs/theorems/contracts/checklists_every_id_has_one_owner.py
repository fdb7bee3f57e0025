"""Every route id that was ever given out belongs to exactly one request, and any other id to none; for
every sequence of requests and every number of ids in each."""

from typing import Any

from cratous.core.contracts.checklists import (
    Owners,
    free_after,
    owners_after,
    owners_of,
    owns,
)
from cratous.proofs.claim import Claim
from cratous.spec.contracts import checklists
from cratous.spec.contracts.checklists import Given

MANY = 2**60


def claim(c: Claim) -> None:
    first, count, number = c.integer("first"), c.integer("count"), c.integer("number")
    c.premise(c.all_of(first >= 1, first <= MANY))
    free = c.use(free_after, first, count)
    c.show(c.all_of(free >= first, free <= MANY), "ids only grow, up to 2^60")
    fits = c.define(checklists.fits, first, count)
    c.show(free == c.when(fits, first + count, first), "a block that fits is given out whole")
    c.show(c.define(checklists.fits, first, 0), "a block of none fits")
    inside = c.use(owns, first, free - first, number)
    place = c.integer("place")
    one_of_it = c.define(checklists.is_number_of_block, first, free - first, number, place)
    c.show(c.implies(one_of_it, inside), "each number of a block is in it")
    counted = c.define(checklists.is_number_of_block, first, free - first, number, number - first)
    c.show(c.implies(inside, counted), "and nothing else")

    # from 1 on, a block of 2 holds the id 2: one more than the 3 that were counted before
    one_more = c.use(owners_after, Owners(1, 3), 2, 2)
    c.show(c.all_of(c.same(one_more.free, 3), c.same(one_more.owners, 4)), "an example")

    def related(o: Any, m: Any) -> Any:
        once = c.define(checklists.owners_due, m.free, number)
        ids = c.all_of(m.free >= 1, m.free <= MANY)
        return c.all_of(c.same(o.free, m.free), c.same(o.owners, m.owners), ids, o.owners == once)

    acc = Owners(c.whole("free"), c.whole("owners"))
    model = Given(c.whole("model_free"), c.whole("model_owners"))
    c.fold(
        owners_of,
        acc=acc,
        model=model,
        item=(count,),
        context=(number,),
        model_start=Given(1, 0),
        model_step=checklists.give_step,
        model_finish=checklists.owners,
        relation=related,
    )
