"""G4 for a vehicle that starts on the ground: whether it took off under ICAROUS, in a reported
roll.

Judged by position, commander, and the reports of its ICAROUS (`TakeOffState`). Modes follow one
another as in `AFTER`. On the ground it moves only while ICAROUS commands, and accelerates only
while a roll is reported. It lifts off once, while a roll is reported. Legs that were not logged
completely are not judged.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from cratous.judge.ground import first_in_the_air, is_at
from cratous.judge.log import Gate, Leaves, Log, State
from cratous.judge.mission import Mission
from cratous.judge.tracks import APART_M, Track
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, seconds

STANDING, ROLLING, CLIMBING, UP = "Standing", "Rolling", "Climbing", "Up"
AFTER = {
    STANDING: {STANDING, ROLLING, CLIMBING},
    ROLLING: {STANDING, CLIMBING},
    CLIMBING: {UP},
    UP: set[str](),
}
NOTICED = 2
"""Maximum delay of a report after lift-off, in heartbeats."""
Fault = tuple[int, str]


def rows(mission: Mission, log: Log, flown: dict[int, Track]) -> Iterator[Row]:
    """One row for each vehicle with an instance that starts on the ground."""
    for vehicle in sorted(mission.instances & mission.grounds.keys()):
        subject, item = ("take-off", str(vehicle)), f"take-off of vehicle {vehicle}"
        said, track = log.leaving.get(vehicle, []), flown.get(vehicle)
        gates = [one for one in log.gates if one.vehicle == vehicle and one.kind == "state"]
        faults = list(_said(mission, said))
        states = [] if track is None else track.states
        first = first_in_the_air(mission, vehicle, states)
        doubt = f"no position of {vehicle} was logged" if track is None else track.doubt
        faults += _rolled(mission, states[: first + 1], said, gates)
        if first < len(states):
            faults += _off(mission, vehicle, states[first - 1 :] if first else states, said)
        elif states and any(
            one.mode in (CLIMBING, UP) and one.time_ms <= states[-1].time_ms for one in said
        ):
            faults.append((said[-1].time_ms, "it said that it had left the ground, and was on it"))
        note = ", ".join(f"{one.mode} from {seconds(one.time_ms)}" for one in _changes(said))
        where = "it stayed on the ground"
        if 0 < first < len(states):
            where = f"off the ground at {seconds(states[first - 1].time_ms)}"
        note = f"{where}; {note}" if note else where
        if faults:
            at, text = min(faults)
            yield Row("G4", subject, item, VIOLATED, f"{text}; {note}", at, len(said))
        elif log.end_ms is None or doubt:
            why = doubt or "the log stops before the mission ends"
            yield Row("G4", subject, item, UNKNOWN, f"{why}; {note}", None, len(said))
        else:
            yield Row("G4", subject, item, HOLDS, note, None, len(said))


def _changes(said: Sequence[Leaves]) -> list[Leaves]:
    """Reports with a mode different from the previous one."""
    found = list[Leaves]()
    for one in said:
        if one.mode != (found[-1].mode if found else STANDING):
            found.append(one)
    return found


def _said(mission: Mission, said: Sequence[Leaves]) -> Iterator[Fault]:
    """Reports that are impossible."""
    mode = STANDING
    for one in said:
        silent_ms = one.time_ms - one.heard_ms
        if one.mode not in AFTER[mode]:
            yield one.time_ms, f"{one.mode} does not follow {mode}"
        if one.mode == ROLLING and not 0 <= silent_ms <= mission.silence_ms:
            yield one.time_ms, f"it rolled after a silence of {silent_ms} ms"
        mode = one.mode


def _mode(said: Sequence[Leaves], at_ms: int) -> str:
    before = [one.mode for one in said if one.time_ms <= at_ms]
    return before[-1] if before else STANDING


def _logged(mission: Mission, before: State, after: State) -> bool:
    """Whether a leg was logged as flown."""
    return after.time_ms - before.time_ms <= mission.step_ms


def _rolled(
    mission: Mission, states: Sequence[State], said: Sequence[Leaves], gates: Sequence[Gate]
) -> Iterator[Fault]:
    """Faults on the ground."""
    fast = 0.0 if states and states[0].time_ms == 0 else math.inf
    for before, after in pairwise(states):
        if not _logged(mission, before, after):
            fast = math.inf
            continue
        moved = math.dist((before.north_m, before.east_m), (after.north_m, after.east_m))
        had = [one.side for one in gates if one.time_ms <= before.time_ms]
        if moved > 0 and (not had or had[-1] != "ICAROUS"):
            yield before.time_ms, "it moved on the ground while UxAS had it"
        if moved > fast + APART_M and _mode(said, before.time_ms) != ROLLING:
            yield before.time_ms, "it rolled faster and was not said to roll"
        fast = moved


def _off(
    mission: Mission, vehicle: int, states: Sequence[State], said: Sequence[Leaves]
) -> Iterator[Fault]:
    """Faults at lift-off, and afterwards."""
    off_ms = states[0].time_ms
    begins = is_at(mission, vehicle, states[0]) or off_ms == 0
    if begins and all(_logged(mission, *leg) for leg in pairwise(states[:2])):
        if _mode(said, off_ms) != ROLLING:
            yield off_ms, "it left the ground and was not said to roll"
        told = [one.time_ms for one in said if one.mode == CLIMBING]
        bound_ms = off_ms + NOTICED * mission.heartbeat_ms
        if states[-1].time_ms > bound_ms and not (told and off_ms <= told[0] <= bound_ms):
            yield off_ms, "it left the ground, and did not say so then"
    for state in states[1:]:
        if not mission.sites and is_at(mission, vehicle, state):
            yield state.time_ms, "it came to the ground again"
            return
