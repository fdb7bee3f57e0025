"""What is kept to is done exactly when as many as have to were at their places from some instant on until now,
without a break, for as long as is asked for; what is done once stays so, and without a time it is never done."""

from cratous.core.tasks.stations import Kept, kept_step
from cratous.proofs.claim import Claim
from cratous.spec import stations


def claim(c: Claim) -> None:
    since, there, needed, now, least = (
        c.integer(name) for name in ("since", "there", "needed", "now", "least")
    )
    done = c.boolean("done")
    c.premise(least >= 0)
    c.premise(now >= 0)
    # since is an instant that has been, or none
    c.premise(since >= stations.NOT_KEPT)
    c.premise(since <= now)
    after = c.use(kept_step, Kept(since, done), there, needed, now, least)
    enough = c.define(stations.enough_at, there, needed)
    c.show(
        c.same(after.since, c.define(stations.since_after, since, there, needed, now)),
        "since the first instant of the unbroken time",
    )
    c.show(c.all_of(after.since >= stations.NOT_KEPT, after.since <= now), "which has been")
    long = c.define(stations.long_enough, after.since, now, least)
    c.show(c.same(after.done, c.any_of(done, long)), "done exactly when it was long enough")
    c.show(c.implies(done, after.done), "and it stays so")
    fresh = c.all_of(after.done, c.negation(done))
    c.show(c.implies(fresh, enough), "never while too few are there")
    c.show(c.implies(fresh, now - after.since >= least), "never before the time is over")
    c.show(c.implies(fresh, least > 0), "and never where no time ends it")
