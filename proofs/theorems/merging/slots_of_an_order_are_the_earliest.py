"""In any order of any number of vehicles: where some assignment gives each a time in its window, a separation after the one
before it, the kernel finds that all fit, and gives nobody a later time than that assignment does. So where it
finds that they do not fit, there is no assignment in that order, and a vehicle without a slot leaves the last slot
and the time from which the fix is free as they were."""

from typing import Any

from cratous.core.merging.slots import Line, in_line, slot_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.merging import slots

MOST = 1 << 60


def claim(c: Claim) -> None:
    line = Line(c.whole("free"), c.boolean("fits"), c.whole("last"))
    earliest, latest, given = c.whole("earliest"), c.whole("latest"), c.whole("given")
    separation, t = c.integer("separation"), c.integer("t")
    c.premise(separation >= 0)
    bounded = c.all_of(earliest >= 0, earliest <= MOST, latest >= 0, latest <= MOST)
    any_line = Line(c.integer("was_free"), c.boolean("did_fit"), c.integer("was_last"))
    window = c.integer("e"), c.integer("l")
    c.premise(separation <= MOST)
    one = c.use(slot_step, any_line, *window, separation)
    meant = c.define(slots.is_next_slot, t, any_line, *window, separation, one)
    c.show(meant, "one slot is its definition")
    kept = c.all_of(one.free == any_line.free, one.time == any_line.time)
    c.show(c.implies(c.negation(one.fits), kept), "a vehicle without a slot takes nothing")

    def after(all_of: list[Any]) -> Any:
        before, (theirs, so, none_later) = all_of
        here = c.use(slot_step, before, earliest, latest, separation)
        follows = c.define(slots.follows, theirs, earliest, latest, given)
        return (
            given + separation,
            c.all_of(so, follows),
            c.all_of(none_later, c.implies(follows, here.time <= given)),
        )

    def invariant(all_of: list[Any]) -> Any:
        held, (theirs, so, none_later) = all_of
        kept = c.all_of(held.fits, held.free <= theirs, none_later)
        return c.all_of(held.free >= 0, held.free <= 2 * MOST, c.implies(so, kept))

    def goal(results: list[Any]) -> Any:
        held, (_, so, none_later) = results
        return c.implies(so, c.all_of(held.fits, none_later))

    along_items(
        c,
        [(in_line, line, (separation,))],
        item=Items((earliest, latest), bounded, (given,)),
        invariant=invariant,
        goal=goal,
        text="earliest",
        beside=[
            Beside(
                (0, True, True),
                (c.whole("theirs"), c.boolean("so"), c.boolean("none_later")),
                after,
            )
        ],
    )
