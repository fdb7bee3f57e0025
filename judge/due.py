"""G4: whether each failure was declared that was due.

A heartbeat begins with a check (`FailureCheck`): whether UxAS stopped the mission, who has the vehicle, since when no
certificate is found, whether something surprised it since the last one, until when the hand lasts. Who has it follows
from `GateState`, the rest from `HandState`: the log must tell the same. Then a failure is due

- at once if the mission is stopped: `blocked` while ICAROUS has the vehicle, `ended` while UxAS has it;
- after four heartbeats without a certificate: `surprised` if it was, else `expiring`, once the hand lasts for less.

It has to be declared at that heartbeat. Only the check tells that the mission is stopped.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cratous.judge.declared import AfterFailure, Event
from cratous.judge.log import Log
from cratous.judge.mission import Mission
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, seconds

RESERVE = 4
"""Heartbeats without a certificate after which a failure is due."""
OFF_THE_GROUND = ("Climbing", "Up")
LAST = ("Final", "Landed")
ANSWERS = ("Offered", "Refused", "Missing")
Fault = tuple[int, str]


@dataclass
class Hand:
    """What the log tells of a vehicle at an instant. quiet: a lack that begins now is not logged."""

    icarous: bool = False
    until_ms: int = 0
    surprises: int = 0
    known: int | None = None
    """Surprises at the last certificate since the takeover; None if there was none."""
    lack_ms: int | None = None
    quiet: bool = False
    flown_ms: int | None = None
    """Since when it has been off the ground; None while it is not known to be."""


def rows(mission: Mission, log: Log) -> Iterator[Row]:
    """One row for each vehicle with an instance."""
    asked = mission.after_failure
    if asked is None:
        return
    for vehicle in sorted(mission.instances):
        subject, item = (
            ("due", str(vehicle)),
            f"failures of vehicle {vehicle} are declared when due",
        )
        events = log.due.get(vehicle, [])
        checks = [one for one in events if one.kind == "FailureCheck"]
        note = f"{len(checks)} checks"
        if vehicle in log.unread:
            yield Row(
                "G4", subject, item, UNKNOWN, f"{log.unread[vehicle]}; {note}", None, len(checks)
            )
            continue
        faults = list(_faults(mission, asked, events, vehicle))
        if faults:
            at, note = min(faults)
            yield Row("G4", subject, item, VIOLATED, note, at, len(checks))
            continue
        doubts = list(_doubts(mission, asked, log, vehicle, events))
        if doubts:
            yield Row("G4", subject, item, UNKNOWN, f"{doubts[0]}; {note}", None, len(checks))
        else:
            yield Row("G4", subject, item, HOLDS, note, None, len(checks))


def _faults(
    mission: Mission, asked: AfterFailure, events: list[Event], vehicle: int
) -> Iterator[Fault]:
    """What is contradictory, and what was due and was not declared."""
    hand, ground = Hand(), vehicle in mission.grounds
    starts = [k for k, one in enumerate(events) if one.kind == "FailureCheck"]
    if not starts:
        return
    for one in events[: starts[0]]:
        _heard(hand, one)
    ends = [*starts[1:], len(events)]
    for start, end in zip(starts, ends, strict=True):
        check, after = events[start], events[start + 1 : end]
        grounded = bool(check.data["OnGround"].flag)
        yield from _told(hand, check, ground and hand.flown_ms is None)
        kind, by_ms = _due(mission, asked, check)
        found, found_ms = check.data["Failure"].text, check.data["DueBy"].whole
        if (found, found_ms) != (kind or "NotDeclared", by_ms):
            own = f"due is {kind or 'none'} by {by_ms} ms"
            yield check.time_ms, f"its check says {found} by {found_ms} ms, {own}"
        due = kind if by_ms <= check.time_ms else ""
        said = next((one for one in after if one.kind == "FailureState"), None)
        if due and (said is None or said.time_ms != check.time_ms):
            yield check.time_ms, f"{due} was due and was not declared"
        elif said is not None and said.time_ms == check.time_ms and said.word != due:
            yield check.time_ms, f"{said.word} is declared, and {due or 'none'} was due"
        if any(one.kind == "FailureState" or one.word in LAST for one in after) and end < len(
            events
        ):
            yield check.time_ms, "it checks again after its last check"
        yield from _answered(hand, check, after, grounded)


def _told(hand: Hand, check: Event, may_stand: bool) -> Iterator[Fault]:
    """Differences between a check and what else is logged."""
    now, data = check.time_ms, check.data
    if data["Flies"].flag != hand.icarous:
        yield now, "its check and its gate differ on who has the vehicle"
    if data["OnGround"].flag and not may_stand:
        yield now, "its check has it on the ground"
    until = data["Expiry"].whole
    if until != hand.until_ms and max(until, hand.until_ms) > now:
        yield now, "its check and its hand expire at different times"
    if not hand.icarous:
        return
    lacks = data["Without"].flag
    if lacks != (hand.lack_ms is not None) or (lacks and data["Since"].whole != hand.lack_ms):
        yield now, "its check tells of another lack of certificates than its hand"
    if lacks and data["Surprised"].flag == (hand.known == hand.surprises):
        yield now, "its check tells of another surprise than its hand"


def _due(mission: Mission, asked: AfterFailure, check: Event) -> tuple[str, int]:
    """The first failure that is due if all stays as a check tells, and by when [ms]; empty and -1 for none."""
    data, reserve_ms = check.data, RESERVE * mission.heartbeat_ms
    stops = "Blocked" if data["Flies"].flag else "Ended"
    if data["Stopped"].flag and stops in asked.of:
        return stops, check.time_ms
    if not (data["Flies"].flag and data["Without"].flag):
        return "", -1
    lacks_ms = max(check.time_ms, data["Since"].whole + reserve_ms)
    if data["Surprised"].flag and "Surprised" in asked.of:
        return "Surprised", lacks_ms
    if "Expiring" not in asked.of:
        return "", -1
    # the first millisecond at which the hand lasts for less
    return "Expiring", max(lacks_ms, data["Expiry"].whole - reserve_ms + 1)


def _answered(hand: Hand, check: Event, after: list[Event], grounded: bool) -> Iterator[Fault]:
    """What is flown and permitted after a check, until the next one."""
    if grounded:
        hand.lack_ms = None
    elif not hand.icarous:
        hand.known, hand.lack_ms = None, None
    had, answer, known = hand.icarous, "", 0
    for one in after:
        taken = one.kind == "GateState" and one.word == "ICAROUS"
        had |= taken and one.time_ms == check.time_ms
        _heard(hand, one)
        if one.kind == "HandState" and one.word in ANSWERS and one.time_ms == check.time_ms:
            answer, known = one.word, hand.surprises
    if grounded:
        return
    if answer in ("Offered", "Refused"):
        hand.known, hand.lack_ms = known, None
    elif (answer or (had and hand.quiet)) and hand.lack_ms is None:
        hand.lack_ms = check.time_ms
    elif had and not answer and hand.lack_ms is None:
        following = any(one.kind == "FailureState" or one.word in LAST for one in after)
        if not following:
            yield check.time_ms, "neither a certificate nor the lack of one is logged"


def _heard(hand: Hand, one: Event) -> None:
    """Take an event into what is known."""
    if one.kind == "GateState":
        takes = one.word == "ICAROUS"
        hand.quiet = hand.quiet and not (takes and not hand.icarous)
        hand.icarous = takes
    elif one.kind == "HandState":
        hand.surprises = one.data["Surprises"].whole
        if one.word != "Refused":
            hand.until_ms = one.data["Expiry"].whole
        if one.word in ("Offered", "Missing"):
            hand.quiet = one.word == "Missing"
    elif one.kind == "TakeOffState" and one.word in OFF_THE_GROUND:
        hand.flown_ms = one.time_ms


def _doubts(
    mission: Mission, asked: AfterFailure, log: Log, vehicle: int, events: list[Event]
) -> Iterator[str]:
    """What the log does not tell."""
    checks = [one for one in events if one.kind == "FailureCheck"]
    if not checks:
        yield "the log tells no checks for failures"
        return
    if log.end_ms is None:
        yield "the log stops before the mission ends"
        return
    beat_ms = mission.heartbeat_ms
    seen = [one.time_ms for one in log.states.get(vehicle, [])] or [0, log.end_ms]
    last_ms = min(seen[-1], log.end_ms)
    if seen[0] > beat_ms:
        yield f"it was not observed before {seconds(seen[0])}"
    over = [one for one in events if one.kind == "FailureState" or one.word in LAST]
    times = [seen[0] - beat_ms, *(one.time_ms for one in checks)]
    if over:
        last_ms = over[0].time_ms
    for before, after in zip(times, [*times[1:], last_ms], strict=True):
        closing = after == last_ms and before == times[-1]
        if after - before > beat_ms or (over and closing and after != before):
            yield f"no check for failures between {seconds(before)} and {seconds(after)}"
    if not over and log.end_ms - last_ms > beat_ms:
        yield f"it was not observed after {seconds(last_ms)}"
    if over or any(one.data["Stopped"].flag for one in checks):
        return
    heard = [one.word for one in events if one.kind == "UxasHeard"]
    if heard[-1:] == ["False"] or checks[-1].data["OnGround"].flag:
        return
    given_up, owner = False, ""
    for one in events:
        owner = one.word if one.kind == "GateState" else owner
        given_up |= one.word == "Blocked" and one.kind == "TaskProgress" and owner == "ICAROUS"
    if given_up and "Blocked" in asked.of:
        yield "a task was given up under ICAROUS, and no check tells that UxAS said so"
    elif log.ends[-1][1] == "failed" and "Ended" in asked.of:
        yield "the mission failed, and no check tells that UxAS said so"
