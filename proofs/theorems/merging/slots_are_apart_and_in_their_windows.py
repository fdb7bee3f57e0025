"""In any order of any number of vehicles whose slots all fit, any two slots are apart by the separation time, the one that
comes later in the order later, and each lies in its vehicle's window. In every order, also one in which some vehicle
has no slot, the last slot is at no negative time, and the fix is not free before it."""

from typing import Any

from cratous.core.merging.slots import Line, in_line, slot_step
from cratous.proofs.claim import Claim
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.spec.merging import slots

MOST = 1 << 60


def claim(c: Claim) -> None:
    line = Line(c.whole("free"), c.boolean("fits"), c.whole("last"))
    earliest, latest = c.whole("earliest"), c.whole("latest")
    first, second = c.boolean("is_first"), c.boolean("is_second")
    separation = c.integer("separation")
    c.premise(c.all_of(separation >= 0, separation <= MOST))
    bounded = c.all_of(earliest >= 0, earliest <= MOST, latest >= 0, latest <= MOST)
    state = tuple(c.whole(n) for n in ("time_a", "time_b"))
    seen = tuple(c.boolean(n) for n in ("seen_a", "seen_b", "good_a", "good_b"))

    def after(all_of: list[Any]) -> Any:
        before, (time_a, time_b, seen_a, seen_b, good_a, good_b) = all_of
        one = c.use(slot_step, before, earliest, latest, separation)
        good = c.define(slots.in_window, earliest, latest, one.time)
        now_a = c.all_of(first, c.negation(seen_a))
        now_b = c.all_of(second, c.negation(first), seen_a, c.negation(seen_b))
        return (
            c.when(now_a, one.time, time_a),
            c.when(now_b, one.time, time_b),
            c.any_of(seen_a, now_a),
            c.any_of(seen_b, now_b),
            c.when(now_a, good, good_a),
            c.when(now_b, good, good_b),
        )

    def last_is_kept(held: Line) -> Any:
        return c.all_of(held.time >= 0, held.time <= held.free)

    def invariant(all_of: list[Any]) -> Any:
        held, (time_a, time_b, seen_a, seen_b, good_a, good_b) = all_of
        return c.all_of(
            held.free >= 0,
            held.free <= 2 * MOST,
            last_is_kept(held),
            c.implies(seen_b, seen_a),
            c.implies(c.all_of(held.fits, seen_a), held.free >= time_a + separation),
            c.implies(c.all_of(held.fits, seen_b), time_b >= time_a + separation),
            c.implies(c.all_of(held.fits, seen_a), good_a),
            c.implies(c.all_of(held.fits, seen_b), good_b),
        )

    def goal(results: list[Any]) -> Any:
        held, (time_a, time_b, _, seen_b, good_a, good_b) = results
        clear = c.define(slots.apart, time_a, time_b, separation)
        whole = c.all_of(clear, time_b >= time_a, good_a, good_b)
        return c.all_of(c.implies(c.all_of(held.fits, seen_b), whole), last_is_kept(held))

    along_items(
        c,
        [(in_line, line, (separation,))],
        item=Items((earliest, latest), bounded, (first, second)),
        invariant=invariant,
        goal=goal,
        text="apart",
        beside=[Beside((0, 0, False, False, False, False), (*state, *seen), after)],
    )
