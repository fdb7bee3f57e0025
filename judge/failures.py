"""G4 after a declared failure: whether it could be declared, what was flown then, and who had the vehicle.

A failure is declared once, and is one of those that the mission asks about. `blocked` needs a task that was given up
before; all but `ended` need that ICAROUS has the vehicle; `expiring` and `surprised` need a lack of certificates
(`HandState`) of four heartbeats. From then on ICAROUS has the vehicle to the end, and flies what the mission chooses,
or a circle. A landing is judged by the vehicle's position, as without the link.
"""

from __future__ import annotations

from collections.abc import Iterator

from cratous.judge.declared import AfterFailure, Declared
from cratous.judge.ground import down
from cratous.judge.log import Alone, Gate, Log
from cratous.judge.lost_link import FINAL, LANDED, LINKED, follows, landing_faults, unseen
from cratous.judge.mission import Mission
from cratous.judge.tracks import Track
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, seconds

BLOCKED, ENDED, ICAROUS = "Blocked", "Ended", "ICAROUS"
OF_HAND = ("Expiring", "Surprised")
FINISH = "Finish"
"""What a vehicle that ICAROUS has flies after a silence of UxAS, before any failure."""
RESERVE = 4
"""Heartbeats without a certificate after which that is declared."""


def rows(mission: Mission, log: Log, flown: dict[int, Track]) -> Iterator[Row]:
    """One row for each vehicle with an instance."""
    asked = mission.after_failure
    if asked is None:
        return
    for vehicle in sorted(mission.instances):
        subject, item = ("failed", str(vehicle)), f"what vehicle {vehicle} does after a failure"
        declared, said = log.declared.get(vehicle, []), log.alone.get(vehicle, [])
        place, track = down(mission, vehicle, flown.get(vehicle)), flown.get(vehicle)
        owners = [g for g in log.gates if (g.vehicle, g.kind) == (vehicle, "state")]
        faults = [*_declared(mission, asked, log, vehicle)]
        faults += _flown(mission, asked, declared, said, owners)
        if log.end_ms is not None and declared and declared[0].said == len(said):
            faults.append((declared[0].time_ms, "nothing was flown after the failure"))
        faults += _kept(log, vehicle, declared)
        if log.end_ms is not None:
            faults += landing_faults(mission, flown, vehicle, said, log.end_ms)
        checks = len(said) + len(declared)
        note = ", ".join(f"{one.failure} at {seconds(one.time_ms)}" for one in declared)
        note = ", ".join([note, *(f"{one.mode} from {seconds(one.time_ms)}" for one in said)])
        note = note or "it declared no failure"
        note += f"; it {place.words()}" if place else ""
        if faults:
            at, text = min(faults)
            yield Row("G4", subject, item, VIOLATED, f"{text}; {note}", at, checks)
        elif log.end_ms is None:
            note = f"the log stops before the mission ends; {note}"
            yield Row("G4", subject, item, UNKNOWN, note, None, checks)
        elif mission.sites and (doubt := unseen(track)):
            yield Row("G4", subject, item, UNKNOWN, f"{note}; {doubt}", None, checks)
        else:
            yield Row("G4", subject, item, HOLDS, note, None, checks)


def _declared(
    mission: Mission, asked: AfterFailure, log: Log, vehicle: int
) -> Iterator[tuple[int, str]]:
    """Failures that could not be declared."""
    said = log.declared.get(vehicle, [])
    for one in said[1:]:
        yield one.time_ms, f"{one.failure} is declared after a failure"
    for one in said:
        if one.failure not in asked.of:
            yield one.time_ms, f"{one.failure} is declared, about which the mission does not ask"
        modes = [flies.mode for flies in log.alone.get(vehicle, [])[: one.said]]
        if modes and modes[-1] in (FINAL, LANDED):
            yield one.time_ms, f"{one.failure} is declared after {modes[-1]}"
        owners = [g.side for g in log.gates if (g.vehicle, g.kind) == (vehicle, "state")
                  and g.time_ms < one.time_ms]  # fmt: skip
        if (one.failure == ENDED) == (owners[-1:] == [ICAROUS]):
            yield one.time_ms, f"{one.failure} is declared under {(owners or ['UxAS'])[-1]}"
        given_up = (p for p in log.progress if p.vehicle == vehicle and p.phase == "Failed")
        if one.failure == BLOCKED and not any(p.time_ms <= one.time_ms for p in given_up):
            yield one.time_ms, "blocked is declared, and no task of it was given up"
        if one.failure in OF_HAND:
            hands = [h for h in log.hands.get(vehicle, []) if h[0] <= one.time_ms]
            since_ms = _without_ms(hands)
            if since_ms is None or one.time_ms - since_ms < RESERVE * mission.heartbeat_ms:
                yield one.time_ms, f"{one.failure} is declared, and certificates were not missing"


def _without_ms(hands: list[tuple[int, str]]) -> int | None:
    """Since when no certificate was found, after these changes of the hand; None if one was."""
    since: int | None = None
    for at_ms, change in hands:
        if change == "Offered":
            since = None
        elif change == "Missing" and since is None:
            since = at_ms
    return since


def _flown(
    mission: Mission,
    asked: AfterFailure,
    declared: list[Declared],
    said: list[Alone],
    owners: list[Gate],
) -> Iterator[tuple[int, str]]:
    """Reports of what is flown that are impossible, or late. The mission's procedure without the link has a row of
    its own. owners: who had the vehicle, by its gate.
    """
    first, mode, begun = (declared[0].said if declared else len(said)), LINKED, False
    for k, one in enumerate(said):
        if k < first:
            if mission.without_link is None:
                had = [gate.side for gate in owners if gate.time_ms <= one.time_ms]
                yield from _without_link(mission, one, mode, had[-1:] == [ICAROUS])
            mode = one.mode
            continue
        # a failure begins what is flown anew
        mode, begun = (mode if begun else LINKED), True
        if one.chosen != asked.choice:
            what = f"{one.chosen} is said to be chosen, the mission wants {asked.choice}"
            yield one.time_ms, what
        if one.mode not in follows(mode, asked.choice) or one.mode == LINKED:
            yield one.time_ms, f"{one.mode} does not follow {mode}"
        mode = one.mode
    if said[first:] and said[first].time_ms != declared[0].time_ms:
        yield declared[0].time_ms, "nothing was flown from when the failure was declared"


def _without_link(mission: Mission, one: Alone, mode: str, had: bool) -> Iterator[tuple[int, str]]:
    """Faults of what is flown before any failure: the known way, then a circle, without the link. A vehicle that senses
    or merges flies nothing by itself then.

    had: whether ICAROUS had the vehicle.
    """
    silent_ms = one.time_ms - one.heard_ms
    nothing = mission.senses or mission.fix is not None
    if nothing or one.chosen != FINISH or one.mode not in follows(mode, FINISH):
        yield one.time_ms, f"{one.mode} is flown, and no failure had been declared"
    elif one.mode != LINKED and silent_ms <= mission.lost_link_after_ms:
        yield one.time_ms, f"{one.mode} after a silence of {silent_ms} ms"
    elif one.mode != LINKED and not had:
        yield one.time_ms, f"{one.mode} is flown, and UxAS has it"
    elif one.mode == LINKED and had and silent_ms > mission.lost_link_after_ms:
        yield one.time_ms, f"{one.mode} after a silence of {silent_ms} ms"


def _kept(log: Log, vehicle: int, declared: list[Declared]) -> Iterator[tuple[int, str]]:
    """Whether ICAROUS had the vehicle from the failure on."""
    if not declared:
        return
    at_ms, had = declared[0].time_ms, [g for g in log.gates if g.vehicle == vehicle]
    states = [one for one in had if one.kind == "state"]
    for one in states:
        if one.time_ms > at_ms and one.side != ICAROUS:
            yield one.time_ms, "UxAS got it back after a declared failure"
    by_then = [one for one in states if one.time_ms <= at_ms]
    if log.end_ms is not None and (not by_then or by_then[-1].side != ICAROUS):
        yield at_ms, "ICAROUS did not have it after the failure"
