"""Declared failures: what an instance has seen of them, and the declaration, for good.

The kernel `failure_step` decides at each heartbeat. Blocked and ended are UxAS's to say: it stops the vehicle's mission
(STOP_MISSION), while ICAROUS has the vehicle or while it has it itself. Surprised and expiring follow from the
certificates: for four heartbeats none was found for the manoeuvres flown. What is flown then is chosen by the mission,
and decided as without the link (`services.icarous.link_loss`), with UxAS as never heard again.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cratous.core.authority.failure import (
    BLOCKED,
    ENDED,
    EXPIRING,
    NONE,
    SURPRISED,
    Asked,
    Failure,
    Seen,
    failure_step,
)
from cratous.core.authority.failure_due import failure_due
from cratous.core.authority.link_loss import FINAL, LANDED
from cratous.services.icarous.messages import (
    Checks,
    Fails,
    FromInstance,
    Offers,
    Sensed,
    Uncertified,
    Wish,
)

RESERVE_BEATS = 4
"""Number of heartbeats that a certificate must cover, and after which its lack is declared."""
WORDS = {
    BLOCKED: "blocked: UxAS has given up a task while ICAROUS had the vehicle",
    EXPIRING: "expiring: what was permitted ends, and nothing that lasts longer is found",
    SURPRISED: "surprised: nothing is permitted against what has become known",
    ENDED: "ended: UxAS has stopped the mission, which cannot be completed",
}


class Beat(NamedTuple):
    """mode: what is flown by itself; flies: ICAROUS has the vehicle; stopped: UxAS has stopped its mission; beat_ms: the
    heartbeat [ms].
    """

    mode: int
    flies: bool
    stopped: bool
    beat_ms: int


class Failing(NamedTuple):
    """failure: as the kernel has it; without: no certificate was found for the last manoeuvre, since since_ms [ms];
    surprises: the hand's count of surprises at the last certificate; had: one was found since ICAROUS took the
    vehicle; last: the intruder that it took over for last, 0 for none; intruder_id, why: what was in the way of the
    last certificate that was refused.
    """

    failure: Failure = Failure(NONE, 0)
    without: bool = False
    since_ms: int = 0
    surprises: int = 0
    had: bool = False
    last: int = 0
    intruder_id: int = 0
    why: str = ""

    @property
    def declared(self) -> bool:
        """Whether a failure has been declared."""
        return self.failure.kind != NONE


def watched(
    before: Failing, asked: Asked, beat: Beat, sensed: Sensed, vehicle_id: int
) -> tuple[Failing, tuple[Checks | Fails, ...]]:
    """The state after a heartbeat, and for the record what was checked, and a failure that is declared."""
    if before.declared or beat.mode in (FINAL, LANDED):
        return before, ()
    hand, without, since_ms = sensed.hand, before.without, before.since_ms
    # without any certificate since the takeover, nothing has been permitted against what is known
    surprised = not before.had or hand.surprises != before.surprises
    seen = Seen(beat.stopped, beat.flies, without, since_ms, surprised, hand.expiry_ms)
    reserve_ms, now_ms = RESERVE_BEATS * beat.beat_ms, sensed.now_ms
    due = failure_due(asked, seen, beat.mode, now_ms, reserve_ms)
    checks = Checks(vehicle_id, now_ms, sensed.on_ground, seen, due)
    failure = failure_step(before.failure, asked, seen, beat.mode, now_ms, reserve_ms)
    after = before._replace(failure=failure)
    return after, (checks, told(after, vehicle_id)) if after.declared else (checks,)


def told(failing: Failing, vehicle_id: int) -> Fails:
    """The declaration, for the record."""
    kind, now_ms = failing.failure
    of_hand = kind in (EXPIRING, SURPRISED)
    intruder_id = failing.intruder_id if of_hand else failing.last if kind == BLOCKED else 0
    reason = WORDS[kind] + (f" ({failing.why})" if of_hand and failing.why else "")
    return Fails(vehicle_id, now_ms, kind, intruder_id, reason)


def noted(before: Failing, sensed: Sensed, out: Sequence[FromInstance]) -> Failing:
    """The state with what the instance has answered at this heartbeat: a certificate, why there is none, or neither. On
    the ground before the take-off none is needed.
    """
    if sensed.on_ground:
        return before._replace(without=False)
    for one in out:
        if isinstance(one, Wish) and one.intruder_id:
            before = before._replace(last=one.intruder_id)
        if isinstance(one, Offers):
            return before._replace(without=False, surprises=sensed.hand.surprises, had=True)
        if isinstance(one, Uncertified):
            since_ms = before.since_ms if before.without else sensed.now_ms
            why = before._replace(intruder_id=one.intruder_id, why=one.reason)
            return why._replace(without=True, since_ms=since_ms)
    return before._replace(without=False, had=False)
