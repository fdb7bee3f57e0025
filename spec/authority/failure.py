"""Declared failures of a vehicle's ICAROUS, after which UxAS commands the vehicle no more.

A failure is declared once and for good. From then on the vehicle flies what the mission chooses for it, as without a
link that never comes back (`spec.authority.link_loss`). Milliseconds.
"""

from typing import NamedTuple

from cratous.spec.authority.link_loss import LINKED, Loss, is_committed

NONE, BLOCKED, EXPIRING, SURPRISED, ENDED = 0, 1, 2, 3, 4
"""Failures: none; a task was given up since ICAROUS kept the vehicle from it; the certificate in hand expires and none
that lasts longer is found; nothing is permitted against what has become known; the mission cannot be completed.
"""
NEVER = -(2**62)
"""When UxAS was last heard, for a vehicle that no longer obeys it [ms]."""


class Failure(NamedTuple):
    """kind: of the declared failure; since_ms: when it was declared [ms]."""

    kind: int
    since_ms: int


class Asked(NamedTuple):
    """The failures after which the mission says what is flown."""

    blocked: bool
    expiring: bool
    surprised: bool
    ended: bool


class Seen(NamedTuple):
    """stopped: UxAS says that the vehicle's mission is over; flies: ICAROUS has the vehicle; without: no certificate has
    been found for what it flies, since since_ms [ms]; surprised: since the last one something became known against
    which the hand is not permitted; expiry_ms: until when the hand is clear [ms].
    """

    stopped: bool
    flies: bool
    without: bool
    since_ms: int
    surprised: bool
    expiry_ms: int


def is_kind(kind: int) -> bool:
    """It is none, or one of the four failures."""
    return not (kind < NONE or kind > ENDED)


def is_blocked(asked: Asked, seen: Seen) -> bool:
    """UxAS has given up a task of a vehicle that ICAROUS has."""
    return asked.blocked and seen.stopped and seen.flies


def is_ended(asked: Asked, seen: Seen) -> bool:
    """UxAS has the vehicle, and has nothing more for it to do."""
    return asked.ended and seen.stopped and not seen.flies


def is_without(seen: Seen, now: int, reserve: int) -> bool:
    """ICAROUS has had no certificate for what it flies, for as long as one has to last at least."""
    return seen.flies and seen.without and not now < seen.since_ms + reserve


def is_surprised(asked: Asked, seen: Seen, now: int, reserve: int) -> bool:
    """Nothing is permitted against what has become known since the last certificate."""
    return asked.surprised and seen.surprised and is_without(seen, now, reserve)


def is_expiring(asked: Asked, seen: Seen, now: int, reserve: int) -> bool:
    """The certificate in hand lasts for less than the reserve, and no other is found."""
    ends = now + reserve > seen.expiry_ms
    return asked.expiring and ends and is_without(seen, now, reserve)


def may_be_declared(before: Failure, mode: int) -> bool:
    """None has been declared, and the vehicle is not in its final descent or on the ground."""
    return before.kind == NONE and not is_committed(mode)


def is_after_heartbeat(
    before: Failure, asked: Asked, seen: Seen, mode: int, now: int, reserve: int, after: Failure
) -> bool:
    """Of the failures that are there and asked about, the first of this order is declared: blocked, ended, surprised,
    expiring. mode: what the vehicle flies by itself; reserve: least duration of a certificate [ms], >= 0.
    """
    if not may_be_declared(before, mode):
        return after == before
    if is_blocked(asked, seen):
        return after == Failure(BLOCKED, now)
    if is_ended(asked, seen):
        return after == Failure(ENDED, now)
    if is_surprised(asked, seen, now, reserve):
        return after == Failure(SURPRISED, now)
    if is_expiring(asked, seen, now, reserve):
        return after == Failure(EXPIRING, now)
    return after == before


def is_heard_by(failure: Failure, heard: int, by: int) -> bool:
    """After a declared failure UxAS counts as never heard. heard: when it was [ms]; by: when it counts as heard."""
    if failure.kind == NONE:
        return by == heard
    return by == NEVER


def is_procedure(failure: Failure, without_link: int, after_failure: int, chosen: int) -> bool:
    """Without the link the procedure for that is flown; from a declared failure on the one for that, link or no link."""
    if failure.kind == NONE:
        return chosen == without_link
    return chosen == after_failure


def is_begun_anew(before: Failure, after: Failure, loss: Loss, begun: Loss) -> bool:
    """When a failure is declared, what was flown by itself until then is left, and what is chosen begins."""
    if before.kind == NONE and after.kind != NONE:
        return begun == Loss(LINKED, after.since_ms)
    return begun == loss
