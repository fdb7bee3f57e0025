"""Rows on whether each failure that was due was declared, on logs made by hand and on logs of flights that are edited."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from flight_logs import both_of, gate, log_of, message, mission_of, says
from ground_tools import Flown, flown_of

from cratous.bridge import lmcp
from cratous.judge import due, failures
from cratous.services.icarous import failing
from cratous.services.loading import load
from cratous.services.monitor import failure_due
from cratous.spec.mission import Mission
from cratous.spec.records import replace

ROW = "failures of vehicle 1 are declared when due"
END_MS, BEAT_MS = 12_000, 500
GOOD, BAD, OPEN = "holds", "violated", "unknown"
NO = {"Failure": "NotDeclared", "DueBy": -1}


def check(now_ms: int, **fields: Any) -> Any:
    return message("FailureCheck", now_ms, **{"VehicleID": 1, "Surprised": True, **NO, **fields})


def hand(change: str, time_ms: int, expiry_ms: int = 0, surprises: int = 0) -> Any:
    more = {"Change": change, "Expiry": expiry_ms, "Surprises": surprises}
    return message("HandState", time_ms, VehicleID=1, **more)


def declared(failure: str, time_ms: int) -> Any:
    return message("FailureState", time_ms, VehicleID=1, Failure=failure)


def under_uxas(first_ms: int = 0, last_ms: int = END_MS) -> list[Any]:
    return [check(t) for t in range(first_ms, last_ms + 1, BEAT_MS)]


def taken(last_ms: int, expiry_ms: int = 12_000) -> list[Any]:
    """ICAROUS takes it at 2 s with a certificate; from 3 s on there is none."""
    start = [*under_uxas(0, 2000), gate("ICAROUS", 2000), hand("Offered", 2000, expiry_ms)]
    going = {"Flies": True, "Surprised": False, "Expiry": expiry_ms}
    start += [check(2500, **going), hand("Offered", 2500, expiry_ms)]
    start += [check(3000, **going), hand("Missing", 3000, expiry_ms)]
    by_ms = max(5000, expiry_ms - 2000 + 1)
    lacks = {**going, "Without": True, "Since": 3000, "Failure": "Expiring"}
    return start + [
        check(t, **{**lacks, "DueBy": max(by_ms, t)}) for t in range(3500, last_ms + 1, BEAT_MS)
    ]


@pytest.fixture(scope="module")
def mission(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Mission:
    folder = tmp_path_factory.mktemp("mission")
    return mission_of(root, folder, on_failure={"choice": "hold"}, landing_sites=None)


def verdicts(mission: Mission, folder: Path, said: list[Any], outcome: str = "complete") -> Any:
    return both_of(mission, log_of({}, *said, end_ms=END_MS, outcome=outcome), ROW, folder)


EXPIRES = [*taken(5000, 6000), declared("Expiring", 5000), says("Loiter", 5000)]
STOPPED = {"Stopped": True, "Failure": "Ended", "DueBy": 3000}
ENDS = [*under_uxas(0, 2500), check(3000, **STOPPED), declared("Ended", 3000)]
BLOCKS = [*taken(4000), check(4500, Flies=True, Without=True, Since=3000, Surprised=False, Expiry=12_000, Stopped=True, Failure="Blocked", DueBy=4500), declared("Blocked", 4500)]  # fmt: skip


LASTS = check(10_000, Flies=True, Without=True, Since=3000, Surprised=False, Expiry=12_000, Failure="Expiring", DueBy=10_001)  # fmt: skip
FOUND_AGAIN = [*taken(9500), LASTS, hand("Offered", 10_000, 20_000)]
for _t in range(10_500, 12_001, BEAT_MS):
    FOUND_AGAIN += [
        check(_t, Flies=True, Surprised=False, Expiry=20_000),
        hand("Offered", _t, 20_000),
    ]


def without(said: list[Any], kind: str, time_ms: int | None = None) -> list[Any]:
    """The messages without those of a kind, at a time if it is given."""
    return [
        one for one in said
        if not (one.topic.endswith(kind) and time_ms in (None, one.time_ms))
    ]  # fmt: skip


def edited(said: list[Any], kind: str, time_ms: int, **fields: Any) -> list[Any]:
    """The messages, one of which says something else."""
    found = []
    for one in said:
        if one.topic.endswith(kind) and one.time_ms == time_ms:
            data = {**json.loads(lmcp.to_json(one.body)), **fields}
            one = type(one)(**{**vars(one), "body": lmcp.from_json(json.dumps(data))})
        found.append(one)
    return found


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        (under_uxas(), GOOD),
        (EXPIRES, GOOD),
        (ENDS, GOOD),
        (BLOCKS, GOOD),
        # it lasts until 10.001 s, and is found again
        (FOUND_AGAIN, GOOD),
        # due and not declared
        (without(EXPIRES, "FailureState"), BAD),
        (without(ENDS, "FailureState"), BAD),
        (without(BLOCKS, "FailureState"), BAD),
        (taken(END_MS, 6000), BAD),
        ([*taken(5500, 6000), declared("Expiring", 5500)], BAD),
        ([*ENDS[:-1], declared("Blocked", 3000)], BAD),
        ([*taken(4500, 6000), declared("Expiring", 4500)], BAD),
        # the log does not tell
        ([], OPEN),
        (without(EXPIRES, "FailureCheck"), OPEN),
        (without(EXPIRES, "FailureCheck", 4000), OPEN),
        (without(EXPIRES, "FailureCheck", 5000), OPEN),
        (without(under_uxas(), "FailureCheck", 0), OPEN),
        (under_uxas(0, END_MS - 1000), OPEN),
        (without(without(EXPIRES, "FailureState"), "FailureCheck", 5000), OPEN),
        # it contradicts itself
        (edited(EXPIRES, "FailureCheck", 5000, Expiry=60_000), BAD),
        (edited(EXPIRES, "FailureCheck", 4500, Expiry=60_000), BAD),
        (edited(EXPIRES, "FailureCheck", 4500, Since=4000), BAD),
        (edited(EXPIRES, "FailureCheck", 4500, Without=False), BAD),
        (edited(EXPIRES, "FailureCheck", 4500, Surprised=True), BAD),
        (edited(EXPIRES, "FailureCheck", 4500, Flies=False), BAD),
        (edited(EXPIRES, "FailureCheck", 4500, OnGround=True), BAD),
        (edited(EXPIRES, "FailureCheck", 5000, DueBy=6000), BAD),
        (edited(EXPIRES, "FailureCheck", 5000, **NO), BAD),
        (edited(EXPIRES, "HandState", 2500, Expiry=60_000), BAD),
        (without(EXPIRES, "HandState", 3000), BAD),
        (without(EXPIRES, "HandState", 2500), BAD),
        (without(EXPIRES, "GateState"), BAD),
        ([*EXPIRES, check(5500)], BAD),
        # the surprise that is not told
        ([*EXPIRES, hand("Known", 4250, 6000, 1)], BAD),
    ],
)  # fmt: skip
def test_a_failure_is_declared_when_due(
    mission: Mission, said: list[Any], expected: str, tmp_path: Path
) -> None:
    said = sorted(said, key=lambda one: one.time_ms)
    assert verdicts(mission, tmp_path, said) == (expected, expected)


@pytest.mark.parametrize(
    ("first_ms", "last_ms", "expected"),
    [(0, END_MS, GOOD), (0, 5000, OPEN), (5000, END_MS, OPEN)],
)
def test_what_was_not_observed_from_beginning_to_end_is_unknown(
    mission: Mission, first_ms: int, last_ms: int, expected: str, tmp_path: Path
) -> None:
    """Neither positions nor checks beyond an instant: nothing contradicts anything, and nothing is known."""
    unseen = [range(first_ms), range(last_ms + 1, END_MS + 1)]
    gap = max(unseen, key=len)
    said = under_uxas(-(-first_ms // BEAT_MS) * BEAT_MS, last_ms)
    paths = {1: lambda now_ms: (0.02 * now_ms, 0.0, 300.0)}
    log = log_of(paths, *said, end_ms=END_MS, outcome="complete", gap=gap)
    assert both_of(mission, log, ROW, tmp_path) == (expected, expected)


BETWEEN = [*under_uxas(0, 2000), gate("ICAROUS", 2250), check(2500, Flies=True)]
BETWEEN += [hand("Offered", 2500, 12_000), check(3000, Flies=True, Surprised=False, Expiry=12_000)]
BETWEEN += [*taken(4000)[-3:], *BLOCKS[-2:]]


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        # told of a later instant only
        (edited(EXPIRES, "FailureCheck", 2500, DueBy=99_999), BAD),
        (edited(EXPIRES, "FailureCheck", 4500, DueBy=5001), BAD),
        (edited(EXPIRES, "FailureCheck", 4500, Failure="Surprised"), BAD),
        # declared, but not at the heartbeat at which it was due
        (edited(ENDS, "FailureState", 3000, Time=3500), BAD),
        (edited(EXPIRES, "FailureState", 5000, Time=0), BAD),
        # the last heartbeat is answered too
        (without(FOUND_AGAIN, "HandState", 12_000), BAD),
        (edited(FOUND_AGAIN, "HandState", 12_000, Time=12_001), BAD),
        # the gate is told after the certificate of the same heartbeat
        ([*without(BLOCKS, "GateState"), gate("ICAROUS", 2000)], GOOD),
        # taken between two heartbeats: the next one is answered
        (BETWEEN, GOOD),
        (without(BETWEEN, "HandState", 2500), BAD),
    ],
)
def test_edits_beside_the_due_heartbeat_are_seen(
    mission: Mission, said: list[Any], expected: str, tmp_path: Path
) -> None:
    said = sorted(said, key=lambda one: one.time_ms)
    assert verdicts(mission, tmp_path, said) == (expected, expected)


GIVEN_UP = message("TaskProgress", 4000, TaskID=1, VehicleID=1, Phase="Failed", Note="blocked: by 90")  # fmt: skip


def flown(last_ms: int = END_MS) -> list[Any]:
    """ICAROUS has it from 2 s on, with a certificate."""
    found = [*under_uxas(0, 2000), gate("ICAROUS", 2000), hand("Offered", 2000, 60_000)]
    for t in range(2500, last_ms + 1, BEAT_MS):
        found += [check(t, Flies=True, Surprised=False, Expiry=60_000), hand("Offered", t, 60_000)]
    return found


@pytest.mark.parametrize(
    ("said", "outcome", "expected"),
    [
        (flown(), "complete", GOOD),
        ([*flown(), GIVEN_UP], "complete", OPEN),
        ([*under_uxas(), GIVEN_UP], "complete", GOOD),
        (under_uxas(), "failed", OPEN),
        ([*under_uxas(), message("UxasHeard", 3000, VehicleID=1, Heard=False)], "failed", GOOD),
        ([*under_uxas(), message("UxasHeard", 3000, VehicleID=1, Heard=True)], "failed", OPEN),
    ],
)
def test_that_uxas_stopped_it_must_be_told(
    mission: Mission, said: list[Any], outcome: str, expected: str, tmp_path: Path
) -> None:
    said = sorted(said, key=lambda one: one.time_ms)
    assert verdicts(mission, tmp_path, said, outcome) == (expected, expected)


def test_a_lack_after_a_refused_certificate_is_not_logged_again(
    mission: Mission, tmp_path: Path
) -> None:
    """The vehicle reports a lack once, until it takes a certificate; the check tells the time of the second."""
    lacks = {"Flies": True, "Without": True, "Surprised": False, "Expiry": 12_000, "Failure": "Expiring"}  # fmt: skip
    said = [*taken(3500), hand("Refused", 3500, 99_000), check(4000, Flies=True, Surprised=False, Expiry=12_000)]  # fmt: skip
    said += [check(t, **lacks, Since=4000, DueBy=max(10_001, t)) for t in range(4500, 10_001, 500)]
    last = check(10_500, **lacks, Since=4000, DueBy=10_500)
    assert verdicts(mission, tmp_path, [*said, last, declared("Expiring", 10_500)]) == (GOOD, GOOD)
    wrong = edited(said, "FailureCheck", 6000, Since=3000)
    assert verdicts(mission, tmp_path, [*wrong, last, declared("Expiring", 10_500)]) == (BAD, BAD)


def test_failures_that_the_mission_does_not_ask_about_are_not_due(
    root: Path, tmp_path: Path
) -> None:
    asks = {"choice": "hold", "of": ["blocked"]}
    mission = mission_of(root, tmp_path, on_failure=asks, landing_sites=None)
    plain = taken(END_MS, 6000)
    for t in range(3500, END_MS + 1, BEAT_MS):
        plain = edited(plain, "FailureCheck", t, **NO)
    assert verdicts(mission, tmp_path, plain) == (GOOD, GOOD)
    assert verdicts(mission, tmp_path, taken(END_MS, 6000)) == (BAD, BAD)
    assert verdicts(mission, tmp_path, without(BLOCKS, "FailureState"))[0] == BAD


BESIDE = {"id": 90, "position": {"north_m": 540, "east_m": 0, "alt_m": 300}, "velocity": {"north_m_s": 22, "east_m_s": 1}, "appears_s": 30, "vanishes_s": 90}  # fmt: skip
FAR = [{"id": 1, "kind": "must_fly", "points": [{"north_m": 3000, "east_m": 0, "alt_m": 300}]}]


@pytest.fixture(scope="module")
def surprised(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Flown:
    data = yaml.safe_load((root / "tests/missions/on_failure.yaml").read_text())
    data |= {"traffic": [BESIDE], "tasks": FAR}
    del data["changes"]
    path = tmp_path_factory.mktemp("mission") / "mission.yaml"
    path.write_text(yaml.safe_dump(data))
    return flown_of(load(path))


def after(flight: Flown, edit: Callable[[str, int, dict[str, Any]], Any], folder: Path) -> Any:
    """What monitor and judge say of a log in which `edit` has changed or removed messages."""
    log = []
    for one in flight.log:
        kind, data = one.topic.rpartition(".")[2], json.loads(lmcp.to_json(one.body))
        if kind in ("FailureCheck", "FailureState", "HandState"):
            data = edit(kind, one.time_ms, data)
        if data is not None:
            log.append(replace(one, body=lmcp.from_json(json.dumps(data))))
    return flight.verdicts(log)[ROW].outcome.value, flight.judged(folder, log)[ROW]


def test_the_log_of_a_flight_cannot_be_edited(surprised: Flown, tmp_path: Path) -> None:
    (said,) = surprised.told("FailureState")
    at_ms, late_ms = said.Time, said.Time + 60_000
    assert after(surprised, lambda k, t, d: d, tmp_path) == (GOOD, GOOD)

    def no_failure(kind: str, _time_ms: int, data: Any) -> Any:
        return None if kind == "FailureState" else data

    assert after(surprised, no_failure, tmp_path) == (BAD, BAD)

    def never_due(kind: str, _time_ms: int, data: Any) -> Any:
        more = {"Expiry": late_ms, "Without": False, "Surprised": False, **NO}
        return {**data, **more} if kind == "FailureCheck" else no_failure(kind, 0, data)

    assert after(surprised, never_due, tmp_path) == (BAD, BAD)

    def unchecked(kind: str, time_ms: int, data: Any) -> Any:
        gone = kind == "FailureCheck" and time_ms == at_ms
        return None if gone else no_failure(kind, 0, data)

    assert after(surprised, unchecked, tmp_path) == (OPEN, OPEN)

    def no_lack(kind: str, _time_ms: int, data: Any) -> Any:
        lacks = kind == "HandState" and data["Change"] == "Missing"
        return None if lacks else never_due(kind, 0, data)

    assert after(surprised, no_lack, tmp_path) == (BAD, BAD)


def test_all_have_the_same_reserve() -> None:
    assert failing.RESERVE_BEATS == failure_due.RESERVE_BEATS == due.RESERVE == failures.RESERVE
