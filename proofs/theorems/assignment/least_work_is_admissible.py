"""What one more task adds to the least work is spent on it: where the tasks so far have spent what was
counted of them, this one has too, and it moves the end of its vehicle's chain by at least its
shortest leg and duration. One step; the sum is made of these, one for each task."""

from cratous.core.assignment.lower_bounds import add_least
from cratous.core.assignment.steps import Chain, chain_step
from cratous.proofs.claim import Claim
from cratous.spec.assignment import bounds as assignment_bounds


def claim(c: Claim) -> None:
    names = ["x", "total", "least", "spent", "more", "travel", "start", "end", "duration", "free"]
    x, total, least, spent, more, travel, start, end, duration, free = map(c.integer, names)
    is_open = c.boolean("is_open")
    for time in (total, least, spent, more, travel, start, end, duration, free):
        c.premise(c.all_of(time >= 0, time <= 2**58))
    result = c.use(add_least, total, is_open, least)
    can = c.define(assignment_bounds.can_be_spent, x, total, is_open, least)
    c.show(c.same(can, x >= result), "it is the least that can be spent")
    # the tasks so far have spent `spent`, this one spends `more`
    c.premise(total <= spent)
    c.show(
        c.implies(c.any_of(least <= more, c.negation(is_open)), result <= spent + more),
        "what was counted is spent",
    )
    # one task of a vehicle's chain: the chain has spent `total` until the vehicle is free
    chain = c.use(chain_step, Chain(True, free), travel, start, end, duration)
    c.premise(c.all_of(chain.ok, total <= free, least <= travel + duration))
    c.show(result <= chain.free, "the end of the chain moves by at least as much")
