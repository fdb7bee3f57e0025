"""A time is in the window of a meeting exactly when each who was asked can arrive then; the common time is the
first of them, and there is none exactly when no time is in it."""

from cratous.core.tasks.rendezvous import Meeting, common_time, meeting_step
from cratous.proofs.claim import Claim
from cratous.spec import rendezvous


def claim(c: Claim) -> None:
    first, last, soonest, latest, t = (
        c.integer(name) for name in ("first", "last", "soonest", "latest", "t")
    )
    c.premise(first >= 0)
    c.premise(soonest >= 0)
    c.premise(last >= rendezvous.NO_END)
    c.premise(latest >= rendezvous.NO_END)
    before = c.define(rendezvous.in_window, first, last, t)
    own = c.define(rendezvous.in_window, soonest, latest, t)
    after = c.use(meeting_step, Meeting(first, last), soonest, latest)
    both = c.define(rendezvous.in_window, after.first, after.last, t)
    c.show(c.same(both, c.all_of(before, own)), "both can arrive then")
    c.show(c.all_of(after.first >= 0, after.last >= rendezvous.NO_END), "and it is a window again")
    common = c.use(common_time, Meeting(first, last))
    none = c.negation(common.found)
    c.show(c.implies(none, c.negation(before)), "where there is none, no time is in it")
    found = c.define(rendezvous.in_window, first, last, common.time)
    c.show(c.implies(common.found, found), "else it is in it")
    c.show(c.implies(c.all_of(common.found, before), common.time <= t), "the first one")
    c.show(c.implies(before, common.found), "and it is found if there is any")
