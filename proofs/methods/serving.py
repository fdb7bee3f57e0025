"""A vehicle on its task chain, heartbeat by heartbeat, with the outcome of its items, by the kernels that decide it."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.executive.steps import end_passed, task_after
from cratous.proofs.claim import Claim
from cratous.proofs.methods.progress import Heartbeat, after_heartbeat
from cratous.proofs.methods.vehicles import counts
from cratous.spec import executive
from cratous.spec.system import ending, serving


class OnChain(NamedTuple):
    """The state of the executive, and the true course of the flight: see `spec.system`."""

    flown: ending.Flown
    course: serving.Course


class Allowed(NamedTuple):
    """most, longest: as in `leg_given_up`; bounds: assumed bounds on takeovers, suspensions and own flying time."""

    most: Any
    longest: Any
    bounds: serving.Bounds


def any_on_chain(c: Claim) -> OnChain:
    """An arbitrary state, with numbers of any size."""
    items, phase = c.whole("items"), c.whole("phase")
    flown = ending.Flown(
        items, phase, c.boolean("suspended"), c.whole("takeovers"), c.whole("under")
    )
    since, own, stay, served, declared, life = (
        c.whole(n) for n in ("since", "own", "stay", "served", "declared", "life")
    )
    truths = c.boolean("home"), c.boolean("bounded")
    return OnChain(flown, serving.Course(since, own, stay, served, declared, life, *truths))


def first_on_chain(items: Any) -> OnChain:
    """The initial state: UxAS is on its way to the first of the items."""
    flown = ending.Flown(items, executive.TRANSIT, False, 0, 0)
    return OnChain(flown, serving.Course(0, 0, 0, 0, 0, executive.LEFT, False, True))


def any_beat(c: Claim) -> Heartbeat:
    """An arbitrary heartbeat."""
    return Heartbeat(c.whole("act"), c.boolean("passed"), c.boolean("opens"), c.whole("dt"))


def after_beat(c: Claim, one: OnChain, beat: Heartbeat, fails: Any, how: Allowed) -> OnChain:
    """The state after a heartbeat. fails: the present task fails for a reason other than ICAROUS."""
    flown, course = one
    counted = [counts(c, n) for n in (flown.takeovers, flown.under_ms, course.life)]
    flown = flown._replace(
        takeovers=c.when(counted[0], flown.takeovers, 0),
        under_ms=c.when(counted[1], flown.under_ms, 0),
    )
    course = course._replace(life=c.when(counted[2], course.life, 0))
    moves = beat._replace(passed=c.all_of(beat.passed, c.negation(fails)))
    after = after_heartbeat(c, flown, moves, how.most, how.longest)
    suspended = after.suspended
    moved = c.use(end_passed, flown.phase, suspended, beat.opens, flown.items > 1)
    begins = c.all_of(moves.passed, moved.act == executive.START)
    ends = c.all_of(moves.passed, moved.act == executive.GO_ON)
    begun = c.when(begins, c.use(task_after, course.life, executive.BEGIN), course.life)
    life = c.when(ends, c.use(task_after, begun, executive.END), begun)
    served = c.all_of(ends, life == executive.ENDED)
    # an item that is left without being served has failed
    left = after.items < flown.items
    failed = c.all_of(left, c.negation(served))
    other = c.all_of(fails, flown.items > 0, c.negation(left))
    gone = c.any_of(left, other)
    onward = c.when(after.items > 1, executive.TRANSIT, executive.DONE)
    flown_on = ending.Flown(
        c.when(other, after.items - 1, after.items),
        c.when(other, onward, after.phase),
        suspended,
        c.when(other, 0, after.takeovers),
        c.when(other, 0, after.under_ms),
    )
    was = flown.suspended
    own = c.when(c.any_of(was, flown.items == 0), course.own_ms, course.own_ms + beat.dt_ms)
    stay = c.when(was, course.stay_ms + beat.dt_ms, 0)
    taken = c.all_of(suspended, c.negation(was))
    takeovers = c.when(taken, flown.takeovers + 1, flown.takeovers)
    kept = c.define(serving.keeps, how.bounds, takeovers, stay, own)
    return OnChain(
        flown_on,
        serving.Course(
            c.when(flown.items == 0, course.since_ms, course.since_ms + beat.dt_ms),
            own,
            c.when(suspended, stay, 0),
            c.when(served, course.served + 1, course.served),
            c.when(c.any_of(failed, other), course.declared + 1, course.declared),
            c.when(gone, executive.LEFT, life),
            c.any_of(course.home, c.all_of(flown_on.items == 0, c.negation(suspended))),
            c.all_of(course.bounded, *counted, kept, c.negation(fails)),
        ),
    )
