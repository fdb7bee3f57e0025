"""A zone that ends in flight: planned for, told to ICAROUS, and held against each leg that was begun before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from flight_tools import flown, meeting, told_to_icarous
from hypothesis import given
from hypothesis import strategies as st
from judge_tools import Edit, edited, verdicts, with_monitor
from judge_tools import Message as Logged

from cratous.bridge.text_protocol import FenceDone, HardReset, StartMission
from cratous.judge import judge
from cratous.services.cli.job import Settings, run_mission
from cratous.services.flight.replan_triggers import undone_by
from cratous.services.loading import load
from cratous.services.mission.zone_times import zones_of
from cratous.services.pipeline.plan import make_plan
from cratous.spec.errors import BadInput
from cratous.spec.mission import Change, Mission, Position, Simulation, TaskKind, Zone, ZoneKind
from cratous.spec.mission.changes import ZONE, ZONE_ENDS, ZoneEnd, known_at, words

FILE = Path(__file__).resolve().parents[1] / "missions" / "zone_ends.yaml"
FENCE = "zone: keep_out 12, flight of vehicle 1"
END_MS = 60_000
RING = ((0.0, 5000.0), (0.0, 5090.0), (90.0, 5090.0))


def flight(mission: Mission, folder: Path) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    report = run_mission(mission, folder, Settings(allow_unproved=True))
    return report, {row["item"]: row for row in report["constraints"] if row["source"] == "flight"}


def outcomes(rows: dict[str, dict[str, Any]]) -> dict[str, str]:
    return {f"task {n}": rows[f"task {n} served"]["verdict"] for n in (7, 8)}


@pytest.fixture(scope="module")
def ended(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any], dict[str, Any]]:
    folder = tmp_path_factory.mktemp("ended")
    return (folder, *flight(load(FILE), folder))


def test_what_the_zone_forbade_is_done_once_it_has_ended(ended: Any) -> None:
    folder, report, rows = ended
    assert report["exit_code"] == 0
    assert outcomes(rows) == {"task 7": "holds", "task 8": "holds"}
    # the plan before the flight left it out
    assert [one["task_id"] for one in report["plan"]["left_out"]] == [8]
    (told,) = report["flight"]["changes"]
    assert "zone 12 ends" in str(told)
    assert "planned anew: tasks 7, 8 may be done, or done whole, without it" in str(told)
    assert rows[FENCE]["verdict"] == "holds"
    # 60 s of legs: what was flown across it later is not held against it, and does not count as its margin
    assert rows[FENCE]["checks"] == END_MS // load(FILE).simulation.step_ms
    assert rows[FENCE]["margin"] > 0
    found = judge(folder, FILE)
    assert [one.line() for one in found.disagreements] == []
    assert {row.verdict for row in found.rows} == {"holds"}


def test_the_map_of_the_report_says_until_when(ended: Any) -> None:
    folder, _, _ = ended
    assert "zone 12, until 60 s" in (folder / "report.html").read_text(encoding="utf-8")


def test_without_the_change_it_is_left_out(tmp_path: Path) -> None:
    report, rows = flight(replace(load(FILE), changes=()), tmp_path)
    assert report["exit_code"] == 1
    assert outcomes(rows) == {"task 7": "violated", "task 8": "violated"}
    assert rows[FENCE]["verdict"] == "holds"
    assert [one.line() for one in judge(tmp_path).disagreements] == []


def into_the_zone(at_ms: int) -> Edit:
    """The position at an instant lies in the zone; the velocities around it lead there and back."""

    def edit(messages: list[Logged]) -> list[Logged]:
        states = [m.body for m in messages if m.kind == "TruthState" and m.body["VehicleID"] == 1]
        k = next(k for k, body in enumerate(states) if body["Time"] == at_ms)
        states[k].update(North=1500.0, East=0.0)
        for p, q in ((states[k - 1], states[k]), (states[k], states[k + 1])):
            dt_s = (q["Time"] - p["Time"]) / 1000
            p["VelocityNorth"] = (q["North"] - p["North"]) / dt_s
            p["VelocityEast"] = (q["East"] - p["East"]) / dt_s
            p["VelocityDown"] = (p["Altitude"] - q["Altitude"]) / dt_s
        return messages

    return edit


@pytest.mark.parametrize(
    ("at_ms", "expected"),
    [
        (END_MS - 10_000, "violated"),
        (END_MS - 250, "violated"),
        (END_MS, "violated"),  # the leg there was begun before the end
        (END_MS + 250, "holds"),
    ],
)
def test_judge_and_monitor_hold_each_leg_that_was_begun_before_the_end(
    ended: Any, tmp_path: Path, at_ms: int, expected: str
) -> None:
    folder, _, _ = ended
    log = edited(folder / "log.sqlite", tmp_path / "log.sqlite", into_the_zone(at_ms))
    found = judge(with_monitor(log))
    assert verdicts(found)[FENCE] == expected
    assert not [one for one in found.differences if FENCE in one.line()]


def test_icarous_forgets_the_zone_and_keeps_the_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    heard = told_to_icarous(monkeypatch)
    first = Zone(4, ZoneKind.KEEP_OUT, RING, 0.0, 900.0)
    both = (first, replace(first, id=5))
    end = ZoneEnd(1000, ZONE_ENDS, zone_id=4)
    flown(replace(meeting(), zones=both, changes=(end,), traffic=(),
                  simulation=Simulation(limit_ms=2000)))  # fmt: skip
    told = [message for vehicle, message in heard if vehicle == 1]
    k = next(k for k, m in enumerate(told) if isinstance(m, HardReset))
    assert [m.zone for m in told[:k] if isinstance(m, FenceDone)] == [1, 2]
    assert [m.zone for m in told[k:] if isinstance(m, FenceDone)] == [1]
    assert any(isinstance(m, StartMission) for m in told[k:])


def test_the_end_of_the_mission_waits_for_a_zone_that_keeps_a_task_out(tmp_path: Path) -> None:
    mission = load(FILE)
    near = replace(
        mission.tasks[0], kind=TaskKind.MUST_FLY, points=(Position(-1800.0, 0.0, 400.0),)
    )
    report, rows = flight(replace(mission, tasks=(near, mission.tasks[1])), tmp_path)
    assert outcomes(rows) == {"task 7": "holds", "task 8": "holds"}
    done = {one["task"]: one["time_ms"] for one in report["flight"]["served"]}
    assert done[7] < END_MS < done[8]
    assert [one.line() for one in judge(tmp_path).disagreements] == []


def test_nothing_is_planned_anew_where_the_plan_is_whole(tmp_path: Path) -> None:
    aside = replace(load(FILE).zones[0], vertices=tuple((n, e + 9000) for n, e in RING))
    report, rows = flight(replace(load(FILE), zones=(aside,)), tmp_path)
    assert "the plan holds as it is" in str(report["flight"]["changes"])
    assert outcomes(rows) == {"task 7": "holds", "task 8": "holds"}


def test_what_was_flown_in_part_to_its_end_is_not_flown_again(tmp_path: Path) -> None:
    """The line that the zone cuts has ended, in part, when the zone ends: nothing asks for another plan."""
    mission = load(FILE)
    far = replace(mission.tasks[1], points=(Position(9000.0, 0.0, 400.0),))
    change = ZoneEnd(360_000, ZONE_ENDS, zone_id=12)
    report, rows = flight(
        replace(mission, tasks=(mission.tasks[0], far), changes=(change,), relations=".(p7 p8)"),
        tmp_path,
    )  # fmt: skip
    done = {one["task"]: one["time_ms"] for one in report["flight"]["served"]}
    (told,) = report["flight"]["changes"]
    assert done[7] < change.at_ms < done[8]
    assert "the plan holds as it is" in str(told)
    assert outcomes(rows) == {"task 7": "violated", "task 8": "holds"}


@pytest.mark.parametrize(
    ("settled", "expected"), [((), [7, 8]), ((7,), [8]), ((8,), [7]), ((7, 8), [])]
)
def test_the_end_of_a_zone_brings_back_no_task_that_has_had_its_end(
    settled: tuple[int, ...], expected: list[int]
) -> None:
    mission = load(FILE)
    (change,) = mission.changes
    assert undone_by(change, make_plan(known_at(mission, 0)), settled) == expected


@given(
    spans=st.lists(st.tuples(st.integers(0, 9000), st.none() | st.integers(1, 9000)), max_size=5),
    step=st.integers(0, 40),
)
def test_the_monitor_holds_a_leg_to_the_zones_that_are_known(
    spans: list[tuple[int, int | None]], step: int
) -> None:
    """At each instant of the simulation those that bind are those of the mission as it is known then."""
    changes = list[Change]()
    for number, (since_ms, length_ms) in enumerate(spans, 1):
        there = Zone(number, ZoneKind.KEEP_OUT, RING, 0.0, 900.0)
        changes.append(Change(since_ms, ZONE, zone=there))
        if length_ms is not None:
            changes.append(ZoneEnd(since_ms + length_ms, ZONE_ENDS, zone_id=number))
    mission = replace(meeting(), zones=(), changes=tuple(changes))
    now_ms = step * mission.simulation.step_ms
    bound = {b.zone.id for b in zones_of(mission, now_ms + 1) if b.binds(now_ms)}
    assert bound == {zone.id for zone in known_at(mission, now_ms).zones}


@pytest.fixture
def loaded(tmp_path: Path) -> Callable[..., Mission]:
    def written(*changes: dict[str, Any]) -> Mission:
        data = yaml.safe_load(FILE.read_text(encoding="utf-8"))
        (tmp_path / "m.yaml").write_text(yaml.safe_dump({**data, "changes": list(changes)}))
        return load(tmp_path / "m.yaml")

    return written


def test_a_zone_of_a_change_may_end_too(loaded: Callable[..., Mission]) -> None:
    there = {"id": 13, "kind": "keep_out", "vertices": [[0, 5000], [0, 5100], [100, 5100]]}
    mission = loaded({"at_s": 5, "zone": there}, {"at_s": 9, "zone_ends": 13})
    assert words(mission.changes[1]) == "zone 13 ends"
    at = [[zone.id for zone in known_at(mission, ms).zones] for ms in (0, 5000, 8999, 9000)]
    assert at == [[12], [12, 13], [12, 13], [12]]


@pytest.mark.parametrize(
    ("at_s", "number", "text"),
    [
        ((5,), 99, "zone 99 does not exist"),
        ((5, 7), 12, "zone 12 ends twice"),
        ((0,), 12, "zone 12 ends before a leg is flown under it"),
        ((5,), "x", "zone_ends"),
    ],
)
def test_an_end_that_cannot_be_is_refused(
    loaded: Callable[..., Mission], at_s: tuple[float, ...], number: Any, text: str
) -> None:
    with pytest.raises(BadInput) as caught:
        loaded(*({"at_s": at, "zone_ends": number} for at in at_s))
    assert text in str(caught.value)
    assert f"changes[{len(at_s) - 1}]" in str(caught.value)
