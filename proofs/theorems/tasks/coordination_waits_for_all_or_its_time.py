"""A request goes out exactly when nobody is missing or its time is over, so it never goes out without somebody
before that, and once it does it does so at every later time."""

from cratous.core.tasks.coordination import goes_out
from cratous.proofs.claim import Claim
from cratous.spec import coordination


def claim(c: Claim) -> None:
    missing, since, now, limit, later = (
        c.integer(name) for name in ("missing", "since", "now", "limit", "later")
    )
    c.premise(missing >= 0)
    c.premise(since >= 0)
    c.premise(now >= since)
    c.premise(later >= now)
    said = c.use(goes_out, missing, since, now, limit)
    c.show(
        c.same(said, c.define(coordination.goes_out, missing, since, now, limit)), "its definition"
    )
    early = c.all_of(said, missing > 0)
    c.show(c.implies(early, c.all_of(limit >= 0, now - since >= limit)), "never early")
    c.show(
        c.implies(said, c.use(goes_out, missing, since, later, limit)), "and at every later time"
    )
