"""The watcher calls two parts in order exactly when the definition does: neither has gone wrong, the second
waited for the first, and the one answer, if it is a plan, came when both were built. A part moves by what
the builder did with that part, and by nothing else."""

from cratous.core.contracts.building import part_after, part_seen, parts_orderly
from cratous.proofs.claim import Claim
from cratous.spec.contracts.building import Parts, in_order


def claim(c: Claim) -> None:
    first, second, plans, errors = (c.integer(n) for n in ("first", "second", "plans", "errors"))
    c.premise(c.all_of(plans >= 0, errors >= 0))
    due, again = plans > 0, plans + errors > 1
    found = c.use(parts_orderly, first, second, due, again)
    c.show(c.same(found, c.define(in_order, Parts(first, second, plans, errors))), "in order")
    stage, part, act, asked, number = (
        c.integer(n) for n in ("stage", "part", "act", "asked", "number")
    )
    done = c.boolean("done")
    seen = c.use(part_seen, stage, part, act, asked, done, number)
    ask, build = c.all_of(act == 1, asked == part), c.all_of(done, number == part)
    c.show(seen == c.use(part_after, stage, ask, build), "a part moves by what was done with it")
