"""G4: whether each failure was declared that was due.

At each heartbeat until it declares a failure, an ICAROUS logs what one follows from (`FailureCheck`). Which failure is
due then is decided by the kernel `failure_due`; it has to be declared at that heartbeat. What is logged there must agree
with what others log: who has the vehicle (`GateState`), until when its certificate lasts, what surprised it, and whether
one was found (`HandState`). That UxAS stopped a vehicle's mission is told there alone. A heartbeat without a check makes
the row unknown, and so does a task that was given up, or a mission that failed, where no check tells of the stop.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from cratous.core.authority.failure import Asked, Seen
from cratous.core.authority.failure_due import failure_due
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.kernel import qualified
from cratous.services.assumptions.authority import has_it, reported
from cratous.services.mission.landing import on_failure_of
from cratous.services.mission.take_off import grounded
from cratous.services.monitor.failure import BLOCKED_NOTE, RESERVE_BEATS
from cratous.services.monitor.required_rows import failure_due_item
from cratous.services.monitor.told_certificates import Certificates
from cratous.spec.authority.failure import NONE
from cratous.spec.authority.link_loss import FINAL, LANDED, LINKED
from cratous.spec.authority.take_off import ROLLING
from cratous.spec.mission import Mission
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.on_failure import Failed

FAILED = "failed"
OLD = "the log tells no checks for failures"


@dataclass
class Told:
    """State of one vehicle. on_ground: it may say so; mode: flown without the link; flies: ICAROUS has it; checked_ms: of
    the last check, -1 before the first; waits: what is due since then, in words; over: a failure is declared, or the
    last descent begun; stopped: a check told that UxAS stopped its mission; given_up: a task of it was, under ICAROUS;
    unheard: it does not hear UxAS; seen_ms: its first and last position.
    """

    on_ground: bool
    mode: int = LINKED
    flies: bool = False
    hand: Certificates = field(default_factory=Certificates)
    checked_ms: int = -1
    waits: str = ""
    over: bool = False
    stopped: bool = False
    given_up: bool = False
    unheard: bool = False
    seen_ms: tuple[int, int] | None = None
    checks: int = 0
    wrong: list[tuple[int, str]] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)


class FailureDueWatch:
    """Whether vehicles with an ICAROUS instance declared what was due; empty if the mission does not ask."""

    kinds = (
        "FailureCheck", "FailureState", "GateState", "HandState", "LinkLossState", "MissionEnd",
        "TakeOffState", "TaskProgress", "TruthState", "UxasHeard",
    )  # fmt: skip

    def __init__(self, mission: Mission) -> None:
        after = on_failure_of(mission)
        self._of = frozenset() if after is None else after.of
        self._asked = Asked(*(one in self._of for one in Failed))
        self._beat_ms = mission.simulation.heartbeat_ms
        stand = {one.id for one in grounded(mission)}
        there = mission.instances if after is not None else ()
        self._told = {number: Told(number in stand) for number in there}
        self._over = False

    def message(self, kind: str, body: Any) -> None:
        """Process a message of one of `kinds`."""
        if kind == "MissionEnd":
            self._end(body)
            return
        told = self._told.get(body.VehicleID)
        if told is None or self._over:
            return
        match kind:
            case "FailureCheck":
                self._check(told, body)
            case "FailureState":
                self._declared(told, body)
            case "GateState":
                flies = has_it(reported(body))
                at_check = in_time(body.Time, told.checked_ms, 0)
                told.hand.held(flies and not told.flies, at_check)
                told.flies = flies
            case "HandState":
                told.hand.changed(body, told.checked_ms)
            case "LinkLossState":
                told.mode = int(body.Mode)
                if told.mode in (FINAL, LANDED) and not told.over:
                    told.over = True
                    if not in_time(told.checked_ms, body.Time, 0):
                        told.doubts.append(_unchecked(told.checked_ms, body.Time))
            case "TakeOffState":
                told.on_ground &= int(body.Mode) <= ROLLING
            case "TaskProgress":
                blocked = body.Phase.name == "Failed" and body.Note.startswith(BLOCKED_NOTE)
                told.given_up |= blocked and told.flies
            case "UxasHeard":
                told.unheard = not body.Heard
            case "TruthState":
                first_ms = told.seen_ms[0] if told.seen_ms else body.Time
                told.seen_ms = (first_ms, body.Time)

    def _check(self, told: Told, body: Any) -> None:
        """What a failure follows from, at a heartbeat."""
        now_ms, wrong = body.Time, told.wrong
        told.checks += 1
        self._settle(told)
        if told.over:
            wrong.append((now_ms, "it checked for failures after the last that it could declare"))
            return
        self._between(told, now_ms)
        hand = told.hand
        hand.passed(told.checked_ms, wrong)
        if body.Flies != told.flies:
            wrong.append((now_ms, "its check and its gate differ on who has the vehicle"))
        if body.OnGround and not told.on_ground:
            wrong.append((now_ms, "its check has it on the ground after it took off"))
        both_over = lasted(body.Expiry, now_ms, 0) and lasted(hand.expiry_ms, now_ms, 0)
        if not in_time(body.Expiry, hand.expiry_ms, 0) and not both_over:
            wrong.append((now_ms, "its check has another expiry than its certificate"))
        if told.flies and body.Flies and (body.Without, body.Without * body.Since) != hand.lack:
            wrong.append((now_ms, "its check and its certificates differ on whether one was found"))
        lacks = told.flies and body.Without
        if lacks and body.Surprised != hand.surprised:
            wrong.append((now_ms, "its check and its certificates differ on a surprise"))
        seen = Seen(body.Stopped, body.Flies, body.Without, body.Since, body.Surprised, body.Expiry)
        reserve_ms = RESERVE_BEATS * self._beat_ms
        due = failure_due(self._asked, seen, told.mode, now_ms, reserve_ms)
        if (int(body.Failure), body.DueBy) != due:
            wrong.append((now_ms, "another failure follows from its check, or at another time"))
        told.stopped |= body.Stopped
        told.checked_ms = now_ms
        hand.began(told.flies, body.OnGround)
        if due.kind != NONE and lasted(due.by_ms, now_ms, 0):
            told.waits = tuple(Failed)[due.kind - 1].value

    def _between(self, told: Told, now_ms: int) -> None:
        """Note heartbeats without a check before this one."""
        before_ms = told.checked_ms
        if told.checks == 1:
            first_ms = told.seen_ms[0] if told.seen_ms else 0
            if not in_time(0, first_ms, self._beat_ms):
                told.doubts.append(f"it was not observed before {first_ms / 1000:.2f} s")
            before_ms = first_ms - self._beat_ms
        if not lasted(now_ms, before_ms + self._beat_ms, 0):
            told.doubts.append(_unchecked(before_ms, now_ms))

    def _settle(self, told: Told) -> None:
        """A failure that was due at the last check was to be declared before the next one."""
        if told.waits:
            text = f"{told.waits} was due and was not declared"
            told.wrong.append((told.checked_ms, text))
        told.waits = ""

    def _declared(self, told: Told, body: Any) -> None:
        """A failure is declared: what was due then."""
        if told.over:
            return
        name, now_ms = body.Failure.name.lower(), body.Time
        if not in_time(told.checked_ms, now_ms, 0):
            self._settle(told)
            told.doubts.append(f"it declared {name} at {now_ms / 1000:.2f} s without a check")
        elif told.waits != name:
            told.wrong.append((now_ms, f"{name} is declared, and {told.waits or 'none'} was due"))
        told.waits, told.over = "", True

    def _end(self, body: Any) -> None:
        """The messages are complete."""
        self._over = True
        for told in self._told.values():
            self._settle(told)
            if told.over:
                continue
            told.hand.passed(told.checked_ms, told.wrong)
            last_ms = min(told.seen_ms[1] if told.seen_ms else body.Time, body.Time)
            if not in_time(last_ms, body.Time, self._beat_ms):
                told.doubts.append(f"it was not observed after {last_ms / 1000:.2f} s")
            if told.checks and lasted(told.checked_ms + self._beat_ms, last_ms, 1):
                told.doubts.append(_unchecked(told.checked_ms, last_ms))
            told.doubts.extend(self._not_told(told, body.Outcome == FAILED))

    def _not_told(self, told: Told, failed: bool) -> Iterator[str]:
        """That UxAS will have stopped the mission, where no check tells so and UxAS is said to be heard."""
        if told.stopped or told.unheard or told.on_ground:
            return
        if told.given_up and Failed.BLOCKED in self._of:
            yield "a task was given up under ICAROUS, and no check tells that UxAS said so"
        elif failed and Failed.ENDED in self._of:
            yield "the mission failed, and no check tells that UxAS said so"

    def verdicts(self) -> list[Verdict]:
        """The row of each vehicle."""
        return [self._verdict(vehicle, told) for vehicle, told in self._told.items()]

    def _verdict(self, vehicle: int, told: Told) -> Verdict:
        outcome, at_ms, note = Outcome.HOLDS, None, f"{told.checks} checks"
        if told.unheard:
            note += "; it did not hear UxAS in the end"
        if told.wrong:
            outcome, (at_ms, note) = Outcome.VIOLATED, min(told.wrong)
        elif not told.checks or not self._over:
            outcome = Outcome.UNKNOWN
            note = "the messages stop too early" if told.checks else OLD
        elif told.doubts:
            outcome, note = Outcome.UNKNOWN, f"{told.doubts[0]}; {note}"
        kernels = (qualified(failure_due),) if told.checks else ()
        return Verdict(
            "G4", failure_due_item(vehicle), outcome, Kind.OBSERVED, note,
            time_ms=at_ms, vehicles=(vehicle,), checks=told.checks, kernels=kernels,
        )  # fmt: skip


def _unchecked(from_ms: int, to_ms: int) -> str:
    return f"no check for failures between {from_ms / 1000:.2f} and {to_ms / 1000:.2f} s"
