"""What a vehicle has left (legs; then takeovers and resumes on the item that it is on; then time) falls at each heartbeat,
whatever ICAROUS and intruders do, and is never below nothing: so it flies its chain to the end, or gives items up, or the
limit ends the flight. On one item ICAROUS takes over no more often than is allowed, and once more."""

from cratous.proofs.claim import Claim
from cratous.proofs.methods.progress import after_heartbeat, any_flown, any_heartbeat
from cratous.spec.system import ending


def claim(c: Claim) -> None:
    flown, beat = any_flown(c), any_heartbeat(c)
    most, longest, now, limit = (c.integer(n) for n in ("most", "longest", "now", "limit"))
    c.premise(c.all_of(most >= 0, longest >= 0, now < limit, most <= 2**56, longest <= 2**56))
    c.premise(beat.dt_ms <= 2**56)
    c.premise(c.define(ending.within, flown, most, longest))
    before = c.define(ending.rank, flown, most, longest, now, limit)
    after = after_heartbeat(c, flown, beat, most, longest)
    left = c.define(ending.rank, after, most, longest, now + beat.dt_ms, limit)
    c.show(c.define(ending.is_rank, before), "it is never below nothing")
    c.show(c.define(ending.is_rank, left), "nor is it afterwards")
    c.show(c.define(ending.falls, before, left), "it falls")
    c.show(c.define(ending.within, after, most, longest), "neither bound is passed")
    taken = c.all_of(after.suspended, c.negation(flown.suspended))
    done = flown.items == 0
    c.show(c.implies(c.negation(done), flown.takeovers <= most), "no more takeovers than allowed")
    here = c.all_of(after.items == flown.items, c.negation(done))
    one_more = c.when(taken, flown.takeovers + 1, flown.takeovers)
    c.show(c.implies(here, after.takeovers == one_more), "each is counted")
    c.show(
        c.implies(c.negation(here), c.any_of(done, after.takeovers == 0)), "of another item none"
    )
