"""G5: heartbeats in both directions, none later than two periods; otherwise the vehicle acts safely
alone.

An undeclared silence is a violation. During a declared silence (BridgeStatus) the vehicle acts
alone: violating a zone or losing well clear is then a violation; otherwise it is not known whether
it would have acted, and the verdict is unknown. In a flight in processes the gate is not on board,
so nothing acts for the vehicle, and any silence is a violation. A heartbeat with a repeated or
lower number is no sign of life. In a flight with the original's clients, whose protocol has none,
it is unknown what ICAROUS would have sent. Downlink messages are logged when sent: with injected
bridge faults their arrival is not known.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from itertools import pairwise

from cratous.judge.log import Beat, Log
from cratous.judge.mission import Mission
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, seconds

PERIODS = 2
IN_PROCESSES = "processes"
"""Meta entry of logs of flights whose gate is in UxAS's process."""
ORIGINAL = "--original-clients"
"""Option in the command of flights with the original's clients."""


def rows(mission: Mission, log: Log, unsafe: dict[int, list[int]]) -> Iterator[Row]:
    """One row for each protected vehicle and direction. unsafe: times at which each violated G1's zones or G2."""
    for vehicle in mission.protected:
        for way, name in (("Down", "to"), ("Up", "from")):
            yield _row(mission, log, (vehicle, way), name, unsafe.get(vehicle, []))


def _row(mission: Mission, log: Log, key: tuple[int, str], name: str, unsafe: list[int]) -> Row:
    vehicle, way = key
    subject = ("beat", str(vehicle), way)
    item = f"heartbeat {name} the ICAROUS instance of {vehicle}"
    if vehicle not in mission.instances:
        note = "the vehicle has no ICAROUS instance: there is no bridge to judge"
        return Row("G5", subject, item, UNKNOWN, note)
    if log.end_ms is None:
        return Row("G5", subject, item, UNKNOWN, "the log stops before the mission ends")
    bound = PERIODS * mission.heartbeat_ms
    beats = log.beats.get(key, [])
    fault = _fault(beats, bound)
    if fault:
        return Row("G5", subject, item, VIOLATED, fault[1], fault[0], len(beats))
    downs = [s.time_ms for s in log.bridges.get(vehicle, []) if not s.alive]
    silent = way == "Up" and ORIGINAL in _words(str(log.meta.get("command", "")))
    if not beats and not downs and (silent or log.end_ms <= bound):
        why = ": its protocol has none" if silent else ""
        return Row("G5", subject, item, UNKNOWN, f"no heartbeat of it is in the log{why}")
    times = [0, *(b.time_ms for b in _news(beats)), log.end_ms]
    gaps = [(b - a, a) for a, b in pairwise(times)]
    longest, since = max(gaps)
    numbers = beats[-1].number - beats[0].number + 1 - len(beats) if beats else 0
    note = f"{len(beats)} heartbeats, longest silence {longest} ms at {seconds(since)}"
    if numbers:
        note += f", {numbers} lost by their numbers"
    silences = [(a, a + gap) for gap, a in gaps if gap > bound]
    if not silences:
        if downs:
            note += f"; said to be down at {seconds(downs[0])} all the same"
            return Row("G5", subject, item, UNKNOWN, note, downs[0], len(beats))
        if mission.faulty_bridge and way == "Down":
            note += (
                "; sent over a bridge that was made to fail, whether they came is not in the log"
            )
            return Row("G5", subject, item, UNKNOWN, note, since, len(beats))
        return Row("G5", subject, item, HOLDS, note, since, len(beats))
    for first, last in silences:
        if not any(first <= at <= last for at in downs):
            note += f"; silent from {seconds(first)}, and nobody declared the bridge down"
            return Row("G5", subject, item, VIOLATED, note, first, len(beats))
        if IN_PROCESSES in log.meta:
            note += f"; down at {seconds(downs[0])}, and the gate is not on board: nobody avoided"
            return Row("G5", subject, item, VIOLATED, note, downs[0], len(beats))
        if any(first <= at <= last for at in unsafe):
            note += f"; silent from {seconds(first)}, and unsafe alone"
            return Row("G5", subject, item, VIOLATED, note, first, len(beats))
    note += (
        "; alone it kept its zones and well clear, whether it would have acted is not in the log"
    )
    return Row("G5", subject, item, UNKNOWN, note, silences[0][0], len(beats))


def _news(beats: list[Beat]) -> list[Beat]:
    """Heartbeats with a number above all previous ones."""
    found: list[Beat] = []
    for beat in beats:
        if not found or beat.number > found[-1].number:
            found.append(beat)
    return found


def _fault(beats: list[Beat], bound: int) -> tuple[int, str] | None:
    """A heartbeat that arrived late, or a log whose time decreases."""
    last: Beat | None = None
    for beat in beats:
        late = beat.logged_ms - beat.time_ms
        if not 0 <= late <= bound:
            return beat.time_ms, f"heartbeat {beat.number} came {late} ms after it was sent"
        if last is not None and beat.time_ms < last.time_ms:
            return beat.time_ms, f"heartbeat {beat.number} came after heartbeat {last.number}"
        last = beat
    return None


def _words(command: str) -> list[str]:
    """The words of a command line as a shell splits them, quotes respected."""
    try:
        return shlex.split(command)
    except ValueError:  # unbalanced quote: not written by a shell
        return command.split()
