"""When a request that is planned together goes out. Definition: `spec.coordination`."""

from cratous.core.authority.timeliness import lasted
from cratous.core.kernel import kernel


@kernel(implements="coordination.goes_out", nonnegative=("missing",))
def goes_out(missing: int, since: int, now: int, limit: int) -> bool:
    """True iff a request that came at `since` [ms] goes out now [ms].

    missing: of how many entities it is not known where they plan from, >= 0; limit: how long they are waited
    for [ms], negative: without an end.
    """
    if missing == 0:
        return True
    if limit < 0:
        return False
    return lasted(since, now, limit)
