"""When a vehicle's ICAROUS has to declare a failure: the first one that is due if what is seen stays, and when.

A failure is due from the first heartbeat on at which `core.authority.failure` declares one. Definition:
`spec.authority.failure_due`.
"""

from typing import NamedTuple

from cratous.core.authority.failure import Asked, Seen
from cratous.core.kernel import kernel


class Due(NamedTuple):
    """kind: of the failure, 0 if none is to come; by_ms: when it is due [ms], -1 for none."""

    kind: int
    by_ms: int


@kernel(implements="authority.failure_due.is_due", nonnegative=("reserve",))
def failure_due(asked: Asked, seen: Seen, mode: int, now: int, reserve: int) -> Due:
    """The first failure that is due from `now` [ms] on if what is seen stays.

    mode: what the vehicle flies by itself, as in `core.authority.link_loss`; reserve: least duration of a certificate
    [ms], >= 0.
    """
    if mode == 6 or mode == 7:
        return Due(0, -1)
    if seen.stopped and seen.flies and asked.blocked:
        return Due(1, now)
    if seen.stopped and not seen.flies and asked.ended:
        return Due(4, now)
    if not (seen.flies and seen.without):
        return Due(0, -1)
    lacking = max(now, seen.since_ms + reserve)
    if seen.surprised and asked.surprised:
        return Due(3, lacking)
    if asked.expiring:
        return Due(2, max(lacking, seen.expiry_ms - reserve + 1))
    return Due(0, -1)
