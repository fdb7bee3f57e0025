"""The rank of a mission falls and cannot fall for ever: no event of a task and no end of a track raises what is left of
the task or the chain, a leg flown to its end lowers it, a lap leaves it; with each step of the clock less time is left,
and when none is, the flight ends, served or not, whatever intruders do; complete only with nothing left."""

from cratous.core.executive.steps import end_passed, flight_outcome, task_after
from cratous.proofs.claim import Claim
from cratous.spec import executive
from cratous.spec.system import ending


def claim(c: Claim) -> None:
    life, event = c.integer("life"), c.integer("event")
    c.premise(c.all_of(life >= executive.LEFT, life <= executive.FAILED))
    after = c.use(task_after, life, event)
    was = c.define(ending.task_steps_left, life)
    now_left = c.define(ending.task_steps_left, after)
    c.show(c.all_of(now_left <= was, now_left >= 0), "a task: never more is left")
    c.show(c.implies(after != life, now_left < was), "a task: each change leaves less")
    phase, items = c.integer("phase"), c.integer("items")
    suspended, opens = c.boolean("suspended"), c.boolean("opens")
    c.premise(c.all_of(phase >= executive.TRANSIT, phase <= executive.DONE))
    c.premise(c.all_of(items >= 0, c.implies(phase != executive.DONE, items >= 1)))
    moved = c.use(end_passed, phase, suspended, opens, items > 1)
    ended = moved.act == executive.GO_ON
    same = c.define(ending.legs_left, items, moved.phase)
    fewer = c.define(ending.legs_left, items - 1, moved.phase)
    legs = c.define(ending.legs_left, items, phase)
    c.show(c.implies(ended, c.all_of(fewer < legs, fewer >= 0)), "a path flown: less is left")
    begun = moved.act == executive.START
    c.show(c.implies(begun, same < legs), "a way flown: less is left")
    c.show(c.implies(c.negation(ended), c.all_of(same <= legs, same >= 0)), "a lap: not more")
    now, later, limit = c.integer("now"), c.integer("later"), c.integer("limit")
    c.premise(c.all_of(now < later, now < limit))
    left_now = c.define(ending.time_left, now, limit)
    left_then = c.define(ending.time_left, later, limit)
    c.show(c.all_of(left_then < left_now, left_then >= 0), "time: less is left")
    flying, away, expected, left = (c.integer(n) for n in ("flying", "away", "expected", "left"))
    c.premise(c.all_of(flying >= 0, away >= 0, expected >= 0, left >= 0))
    how = c.use(flight_outcome, flying, away, expected, left, later, limit)
    c.show(c.implies(left_then == 0, how != executive.GOES_ON), "with no time left it ends")
    complete = how == executive.COMPLETE
    nothing = c.all_of(flying == 0, away == 0, expected == 0, left == 0)
    c.show(c.implies(complete, nothing), "complete only with nothing left")
