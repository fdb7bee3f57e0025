"""Over any number of heartbeats, while no more takeovers come on an item than are allowed and none lasts so long that its
item could be given up for them, and nothing else fails a task, no item is declared as failed, whatever intruders do:
each is flown to its end; the chain is at its end no later than UxAS flies it and ICAROUS may stay in all; and UxAS has
the vehicle then, so that a flight of which no more is expected is complete."""

from typing import Any

from cratous.core.executive.steps import completes, flight_outcome
from cratous.proofs.claim import Claim
from cratous.proofs.methods.hands import MOST
from cratous.proofs.methods.runs import Beside, Items, along_items
from cratous.proofs.methods.serving import (
    Allowed,
    after_beat,
    any_beat,
    any_on_chain,
    first_on_chain,
)
from cratous.proofs.methods.vehicles import counts
from cratous.spec import executive
from cratous.spec.system import serving


def claim(c: Claim) -> None:
    items, most, longest = c.integer("chain"), c.integer("most"), c.integer("longest")
    bounds = serving.Bounds(items, *(c.integer(n) for n in ("few", "short", "flying")))
    c.premise(c.all_of(items >= 1, bounds.own_ms >= 0))
    c.premise(c.define(serving.allowed, bounds, most, longest))
    limit = c.integer("limit")
    c.premise(c.define(serving.longest_ms, bounds) <= limit)
    how = Allowed(most, longest, bounds)
    one, beat, fails = any_on_chain(c), any_beat(c), c.boolean("fails")
    each = c.all_of(beat.dt_ms >= 1, beat.dt_ms <= MOST, counts(c, beat.act))
    stays = c.define(serving.stays_ms, bounds)

    def goal(state: list[Any]) -> Any:
        flown, course = state[0]
        served = c.define(serving.is_served, bounds, flown, course)
        # of a flight of this vehicle alone, which its gate says to be UxAS's as well
        done = c.all_of(course.bounded, flown.items == 0)
        ended = c.when(done, course.since_ms, 0)
        left = c.when(done, bounds.items - course.served, 0)
        outcome = c.use(flight_outcome, 0, 0, 0, left, ended, limit)
        complete = c.all_of(outcome == executive.COMPLETE, c.use(completes, outcome, ended, limit))
        return c.all_of(served, c.implies(done, complete))

    def invariant(state: list[Any]) -> Any:
        flown, course = state[0]
        left, done = flown.items, flown.items == 0
        phases = c.all_of(flown.phase >= executive.TRANSIT, flown.phase <= executive.DONE)
        numbers = c.all_of(left >= 0, flown.takeovers >= 0, flown.takeovers <= bounds.takeovers)
        begun = c.same(flown.phase == executive.TASK, course.life == executive.BEGUN)
        lives = c.any_of(course.life == executive.LEFT, course.life == executive.BEGUN)
        under = flown.takeovers * bounds.stay_ms
        now = c.when(flown.suspended, course.stay_ms, bounds.stay_ms)
        times = c.all_of(
            course.since_ms >= 0,
            course.stay_ms <= bounds.stay_ms,
            course.own_ms <= bounds.own_ms,
            c.any_of(done, flown.under_ms <= under + now),
            course.since_ms
            <= course.own_ms + (bounds.items - left) * stays + c.when(done, 0, flown.under_ms),
        )
        shape = c.all_of(c.same(flown.phase == executive.DONE, done), numbers, lives)
        begun = c.any_of(done, begun)
        bounded = c.implies(course.bounded, c.all_of(shape, begun, times))
        return c.all_of(phases, bounded, goal(state))

    def after(state: list[Any]) -> Any:
        return after_beat(c, state[0], beat, fails, how)

    along_items(
        c,
        [],
        item=Items((), each, (beat, fails)),
        invariant=invariant,
        goal=goal,
        text="served",
        beside=[Beside(first_on_chain(items), one, after)],
    )
