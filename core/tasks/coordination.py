"""When a jointly planned request is released. Definition: `spec.coordination`."""

from cratous.core.authority.timeliness import lasted
from cratous.core.kernel import kernel


@kernel(implements="coordination.goes_out", nonnegative=("missing",))
def goes_out(missing: int, since: int, now: int, limit: int) -> bool:
    """True iff a request that came at `since` [ms] is released now [ms].

    missing: number of entities whose planning state is not known, >= 0; limit: how long they are waited for [ms],
    negative: no limit.
    """
    if missing == 0:
        return True
    if limit < 0:
        return False
    return lasted(since, now, limit)
