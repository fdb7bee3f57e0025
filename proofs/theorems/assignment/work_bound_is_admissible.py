"""The work that one more vehicle can do until an instant, after it is free, is never more than the room
that it adds to that of the others, and where the room of all is less than the work some is left. One
step; the room of all vehicles is made of these, one for each."""

from cratous.core.assignment.steps import lacks_room, room_step
from cratous.proofs.claim import Claim
from cratous.spec.assignment import search as assignment


def claim(c: Claim) -> None:
    room, until, free, work = (c.integer(name) for name in ["room", "until", "free", "work"])
    done, more = c.integer("done_by_the_others"), c.integer("done_by_this_one")
    for time in (room, free, work, done, more):
        c.premise(c.all_of(time >= 0, time <= 2**59))
    c.premise(c.all_of(until >= -(2**59), until <= 2**59))
    total = c.use(room_step, room, until, free)
    can = c.define(assignment.work_is_done, work, room, until, free)
    c.show(c.same(can, work <= total), "the room is exactly what can be done")
    # the others do no more than their room; this one works from when it is free to its last end
    c.premise(done <= room)
    c.premise(c.any_of(more == 0, free + more <= until))
    c.show(done + more <= total, "no more is done than there is room for")
    lacks = c.use(lacks_room, total, work)
    all_done = c.define(assignment.all_is_done, total, work, done + more)
    c.show(c.implies(lacks, c.negation(all_done)), "whoever does what, not all is done")
    fits = c.define(assignment.all_is_done, total, work, work)
    c.show(c.implies(c.negation(lacks), fits), "else the room suffices for all")
    c.show(c.implies(lacks, done + more < work), "then some work is left over")
