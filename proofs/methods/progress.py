"""One heartbeat of the executive with one vehicle on its task chain, composed of the kernels that decide it."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.authority.link_end import suspended_after
from cratous.core.executive.steps import end_passed, leg_given_up
from cratous.proofs.claim import Claim
from cratous.spec import executive
from cratous.spec.system import ending


class Heartbeat(NamedTuple):
    """act: of the UxAS end, on what it has heard of ICAROUS; passed: the end of the present track was passed; opens:
    the next task may begin; dt_ms: time since the previous heartbeat [ms]."""

    act: Any
    passed: Any
    opens: Any
    dt_ms: Any


def any_flown(c: Claim) -> ending.Flown:
    """An arbitrary vehicle on its chain, with `items` left."""
    items, phase = c.integer("items"), c.integer("phase")
    c.premise(c.all_of(phase >= executive.TRANSIT, phase <= executive.DONE))
    c.premise(c.all_of(items >= 0, c.same(phase == executive.DONE, items == 0)))
    takeovers, under = c.integer("takeovers"), c.integer("under")
    c.premise(c.all_of(takeovers >= 0, under >= 0))
    return ending.Flown(items, phase, c.boolean("suspended"), takeovers, under)


def any_heartbeat(c: Claim) -> Heartbeat:
    """An arbitrary heartbeat, at least 1 ms after the previous one."""
    dt = c.integer("dt")
    c.premise(dt >= 1)
    return Heartbeat(c.integer("act"), c.boolean("passed"), c.boolean("opens"), dt)


def after_heartbeat(
    c: Claim, one: ending.Flown, beat: Heartbeat, most: Any, longest: Any
) -> ending.Flown:
    """The vehicle after a heartbeat: takeovers by ICAROUS are counted, a passed end of the track is processed, and
    the item may be given up. Counts start anew with the next item."""
    suspended = c.use(suspended_after, one.suspended, beat.act)
    taken = c.all_of(suspended, c.negation(one.suspended))
    takeovers = c.when(taken, one.takeovers + 1, one.takeovers)
    under = c.when(one.suspended, one.under_ms + beat.dt_ms, one.under_ms)
    moved = c.use(end_passed, one.phase, suspended, beat.opens, one.items > 1)
    ended = c.all_of(beat.passed, moved.act == executive.GO_ON)
    phase = c.when(beat.passed, moved.phase, one.phase)
    items = c.when(ended, one.items - 1, one.items)
    takeovers, under = c.when(ended, 0, takeovers), c.when(ended, 0, under)
    over = c.use(leg_given_up, takeovers, most, under, longest)
    given_up = c.all_of(over, phase != executive.DONE)
    onward = c.when(items > 1, executive.TRANSIT, executive.DONE)
    return ending.Flown(
        c.when(given_up, items - 1, items),
        c.when(given_up, onward, phase),
        suspended,
        c.when(given_up, 0, takeovers),
        c.when(given_up, 0, under),
    )
