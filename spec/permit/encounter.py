"""Bounds on how often ICAROUS takes over because of one intruder.

A takeover ends with a permit: control goes back only on a path that is permitted against the intruder. So there is
one takeover, and one more for each permit that did not last: because of a *surprise*, an event that it does not
cover, or because of its *end*. Milliseconds of one clock.
"""

from __future__ import annotations

from typing import NamedTuple


class Encounter(NamedTuple):
    """takeovers, surprises, ended: counts; avoiding: a takeover is in progress; permitted: until expiry_ms [ms]."""

    takeovers: int
    surprises: int
    ended: int
    avoiding: bool
    permitted: bool
    expiry_ms: int


def bounded(one: Encounter) -> bool:
    """The number of takeovers is at most one plus the number of permits that did not last."""
    return one.takeovers <= 1 + one.surprises + one.ended


def owed(one: Encounter) -> bool:
    """Each takeover, except one in progress or covered by a permit in force, has a permit that did not last."""
    open_now = 1 if one.avoiding or one.permitted else 0
    counts = one.takeovers >= 0 and one.surprises >= 0 and one.ended >= 0
    return counts and one.takeovers <= one.surprises + one.ended + open_now


def same_counts(before: Encounter, after: Encounter, surprises: int, ended: int) -> bool:
    """No new takeover, and these numbers of new surprises and ends."""
    more = after.surprises == before.surprises + surprises and after.ended == before.ended + ended
    return more and after.takeovers == before.takeovers


def without_permit(after: Encounter) -> bool:
    """Nothing is permitted."""
    return not after.permitted and after.expiry_ms == 0


def is_after_look(before: Encounter, allowed: bool, now: int, after: Encounter) -> bool:
    """A permit whose time has passed has ended; one that does not cover what is observed is a surprise; otherwise
    nothing changes.
    """
    if before.permitted and now >= before.expiry_ms:
        over = same_counts(before, after, 0, 1) and without_permit(after)
        return over and after.avoiding == before.avoiding
    if before.permitted and not allowed:
        over = same_counts(before, after, 1, 0) and without_permit(after)
        return over and after.avoiding == before.avoiding
    return after == before


def is_after_watch(before: Encounter, foreseen: bool, after: Encounter, acts: bool) -> bool:
    """ICAROUS takes over if a conflict is predicted, no permit is in force and no takeover is in progress; otherwise
    nothing changes.
    """
    if not (foreseen and not before.permitted and not before.avoiding):
        return after == before and not acts
    one_more = after.takeovers == before.takeovers + 1 and after.avoiding
    same = after.surprises == before.surprises and after.ended == before.ended
    return acts and one_more and same and without_permit(after)


def is_after_handback(before: Encounter, allowed: bool, expiry: int, after: Encounter) -> bool:
    """The takeover is over: what is flown is permitted until the expiry. If it is not permitted, a takeover in
    progress or a permit in force now counts as a surprise.
    """
    if allowed:
        permitted = after.permitted and after.expiry_ms == expiry and not after.avoiding
        return permitted and same_counts(before, after, 0, 0)
    if before.avoiding or before.permitted:
        over = same_counts(before, after, 1, 0) and without_permit(after)
        return over and not after.avoiding
    return after == before
