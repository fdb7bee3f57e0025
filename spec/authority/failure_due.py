"""When a failure is due: from the first instant on at which one is there that the mission asks about.

The definition refers to instants: it takes the instant that it quantifies over as its first argument; instants are
integers, milliseconds.
"""

from typing import NamedTuple

from cratous.spec.authority.failure import (
    BLOCKED,
    ENDED,
    EXPIRING,
    NONE,
    SURPRISED,
    Asked,
    Seen,
    is_blocked,
    is_ended,
    is_expiring,
    is_surprised,
)
from cratous.spec.authority.link_loss import is_committed


class Due(NamedTuple):
    """kind: of the failure that is due first, NONE if none is to come; by_ms: when it is due [ms]."""

    kind: int
    by_ms: int


def is_any_there(asked: Asked, seen: Seen, mode: int, at: int, reserve: int) -> bool:
    """At an instant, one of the failures is there that the mission asks about, and it may still be declared."""
    at_once = is_blocked(asked, seen) or is_ended(asked, seen)
    lacks = is_surprised(asked, seen, at, reserve) or is_expiring(asked, seen, at, reserve)
    return not is_committed(mode) and (at_once or lacks)


def is_there(kind: int, asked: Asked, seen: Seen, at: int, reserve: int) -> bool:
    """At an instant, this failure is there, and none that is declared before it."""
    if is_blocked(asked, seen):
        return kind == BLOCKED
    if is_ended(asked, seen):
        return kind == ENDED
    if is_surprised(asked, seen, at, reserve):
        return kind == SURPRISED
    return kind == EXPIRING and is_expiring(asked, seen, at, reserve)


def is_due(t: int, asked: Asked, seen: Seen, mode: int, now: int, reserve: int, due: Due) -> bool:
    """If what is seen stays, no failure is there at the instant t from now on and before the one that is due; at that
    instant it is there. Without one that is due, none is there at any t.

    FOR ALL t. mode: what the vehicle flies by itself; reserve: least duration of a certificate [ms], >= 0.
    """
    if t < now:
        return True
    if due.kind == NONE or t < due.by_ms:
        return not is_any_there(asked, seen, mode, t, reserve)
    if t == due.by_ms:
        return not is_committed(mode) and is_there(due.kind, asked, seen, t, reserve)
    return True
