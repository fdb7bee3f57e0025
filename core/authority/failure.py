"""Declared failures of a vehicle's ICAROUS: which one is declared, and what then counts as heard. Transition kernels.

NONE (0). BLOCKED (1): UxAS has given up a task since ICAROUS kept the vehicle from it. EXPIRING (2): the certificate
in hand expires, and no other is found. SURPRISED (3): nothing is permitted against what has become known. ENDED (4):
the mission cannot be completed. A failure is for good: what is flown then is decided by `core.authority.link_loss`,
with UxAS as never heard again. Definitions: `spec.authority.failure`.
"""

from typing import NamedTuple

from cratous.core.authority.link_loss import Loss
from cratous.core.authority.timeliness import lasted
from cratous.core.kernel import kernel

NONE, BLOCKED, EXPIRING, SURPRISED, ENDED = 0, 1, 2, 3, 4


class Failure(NamedTuple):
    """kind: see above; since_ms: when it was declared [ms]."""

    kind: int
    since_ms: int


class Asked(NamedTuple):
    """The failures after which the mission says what is flown."""

    blocked: bool
    expiring: bool
    surprised: bool
    ended: bool


class Seen(NamedTuple):
    """stopped: UxAS says that the vehicle's mission is over; flies: ICAROUS has the vehicle; without: no certificate was
    found for what it flies, since since_ms [ms]; surprised: since the last one something became known against which the
    hand is not permitted; expiry_ms: until when the hand is clear [ms].
    """

    stopped: bool
    flies: bool
    without: bool
    since_ms: int
    surprised: bool
    expiry_ms: int


@kernel(implements="authority.failure.is_after_heartbeat", nonnegative=("reserve",))
def failure_step(
    failure: Failure, asked: Asked, seen: Seen, mode: int, now: int, reserve: int
) -> Failure:
    """A heartbeat of the instance.

    mode: what the vehicle flies by itself, as in `core.authority.link_loss`; now: [ms]; reserve: least duration of a
    certificate [ms], >= 0.
    """
    if failure.kind != 0 or mode == 6 or mode == 7:
        return failure
    if seen.stopped and seen.flies and asked.blocked:
        return Failure(1, now)
    if seen.stopped and not seen.flies and asked.ended:
        return Failure(4, now)
    if seen.flies and seen.without and lasted(seen.since_ms, now, reserve):
        if seen.surprised and asked.surprised:
            return Failure(3, now)
        if asked.expiring and not lasted(now, seen.expiry_ms, reserve):
            return Failure(2, now)
    return failure


@kernel(implements="authority.failure.is_heard_by")
def heard_by(failure: Failure, heard: int) -> int:
    """When UxAS counts as last heard [ms]: never, after a declared failure. heard: when it was [ms]."""
    if failure.kind == 0:
        return heard
    return -4611686018427387904


@kernel(implements="authority.failure.is_procedure")
def procedure(failure: Failure, without_link: int, after_failure: int) -> int:
    """What is flown by itself: without_link, the mission's choice without the link, until a failure is declared, then
    after_failure, its choice after that, for good.
    """
    if failure.kind == 0:
        return without_link
    return after_failure


@kernel(implements="authority.failure.is_begun_anew")
def loss_declared(before: Failure, after: Failure, loss: Loss) -> Loss:
    """What the vehicle flies by itself at the beginning of a heartbeat. before, after: the failure around it."""
    if before.kind == 0 and after.kind != 0:
        return Loss(0, after.since_ms)
    return loss
