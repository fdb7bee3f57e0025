"""The judge on authority, on the bridge, and beside a report: hand-made flights with known verdicts."""

from __future__ import annotations

import json
from pathlib import Path

import judge_tools as tools
import pytest
from judge_tools import TAKEN, Scene, full, row, task, vehicle, verdicts, zone

from cratous.judge import judge
from cratous.services.cli import main

NORTH = (20.0, 0.0, 0.0)


def one(folder: Path, scene: Scene, item: str) -> str:
    """The verdict on one item."""
    return verdicts(scene.judged(folder))[item]


# ---- G4 -----------------------------------------------------------------------------------------


def authority(folder: Path, rows: list, **more) -> str:
    scene = Scene(**more).straight(1, (0, 0, 300), NORTH).commands(1, *rows)
    return one(folder, scene, "authority over vehicle 1")


def test_a_takeover_that_is_handed_back(tmp_path: Path) -> None:
    assert authority(tmp_path, TAKEN) == "holds"
    assert authority(tmp_path, TAKEN[:1]) == "holds"
    assert authority(tmp_path, []) == "unknown"
    withdrawn = [*TAKEN[:7], (5200, "state", "ICAROUS", 3)]
    back = [(6000, "state", "ICAROUS", 4, True), (6100, "command", "UxAS", 4),
            (6100, "state", "UxAS", 4), (6100, "change", "UxAS", 4)]  # fmt: skip
    assert authority(tmp_path, withdrawn + back) == "holds"


@pytest.mark.parametrize("left_out", [1, 2, 3, 5, 6, 8, 9, 10])
def test_a_story_with_a_hole(tmp_path: Path, left_out: int) -> None:
    rows = [row for k, row in enumerate(TAKEN) if k != left_out]
    # that ICAROUS steered is not needed for the story
    assert authority(tmp_path, rows) == ("holds" if left_out == 3 else "violated")


@pytest.mark.parametrize(
    "rows",
    [
        [*TAKEN[:7]],  # never handed back
        [TAKEN[0], (1000, "command", "ICAROUS", 0)],  # steers without a takeover
        [TAKEN[0], (1000, "command", "UxAS", 1)],  # of an epoch that is not yet
        [TAKEN[0], (1000, "drop", "UxAS", 0)],
        [TAKEN[0], (1000, "state", "UxAS", 1)],
        [TAKEN[0], (1000, "state", "ICAROUS", 2), (1000, "change", "ICAROUS", 2)],
        [TAKEN[0], (1000, "change", "ICAROUS", 1)],
        [*TAKEN[:5], (5000, "state", "UxAS", 2), (5000, "change", "UxAS", 2)],
        # UxAS takes what was not offered
        [
            *TAKEN[:4],
            (5000, "command", "UxAS", 1),
            (5000, "state", "UxAS", 1),
            (5000, "change", "UxAS", 1),
        ],
    ],
)
def test_stories_that_do_not_fit(tmp_path: Path, rows) -> None:
    assert authority(tmp_path, rows) == "violated"


@pytest.mark.parametrize(
    ("gate", "expected"), [({"Time": 500}, "holds"), ({}, "unknown"), ({"Time": "soon"}, "unknown")]
)
def test_what_is_due_is_unknown_where_a_message_lacks_its_time(
    tmp_path: Path, gate: dict[str, object], expected: str
) -> None:
    well_clear = {"dthr_m": 150.0, "zthr_m": 30.0, "tthr_s": 15.0, "tcoa_s": 0.0}
    daa = {"well_clear": well_clear, "on_failure": {"choice": "hold", "sites": []}}
    scene = Scene(instances=[1], daa=daa).straight(1, (0, 0, 300), NORTH)
    no = dict.fromkeys(("Stopped", "Flies", "Without", "OnGround"), False)
    for at in range(0, 10_001, 500):
        said = {"VehicleID": 1, "Time": at, "Since": 0, "Expiry": 0, "Surprised": True, **no}
        scene.say(at, "FailureCheck", **said, Failure="NotDeclared", DueBy=-1)
    body = {"VehicleID": 1, "Owner": "UxAS", "Epoch": 0, "Offered": False}
    scene.say(500, "GateState", **body, **gate)
    assert one(tmp_path, scene, "failures of vehicle 1 are declared when due") == expected


def test_a_task_that_fails_ends_no_takeover(tmp_path: Path) -> None:
    scene = Scene(tasks=[task(1, "must_fly", (100, 0))]).straight(1, (0, 0, 300), NORTH)
    scene.commands(1, *TAKEN[:4])
    scene.say(7000, "TaskProgress", TaskID=1, VehicleID=1, Time=7000, Phase="Failed")
    assert one(tmp_path, scene, "authority over vehicle 1") == "violated"


@pytest.mark.parametrize(
    ("status", "expected"),
    [
        ([], "violated"),
        ([(500, False)], "unknown"),  # before the takeover
        ([(3000, False)], "unknown"),
        ([(3000, True)], "violated"),
        ([(3000, False), (4000, True)], "violated"),  # alive again, and still not handed back
        ([(3000, False), (4000, True), (5000, False)], "unknown"),
        ([(3000, False, 2)], "violated"),  # another vehicle's
    ],
)
def test_a_takeover_that_is_open_at_the_end_is_unknown_only_where_the_link_is_declared_down(
    tmp_path: Path, status: list[tuple], expected: str
) -> None:
    def scene(rows: list) -> Scene:
        made = Scene(vehicles=[vehicle(1), vehicle(2)]).straight(1, (0, 0, 300), NORTH)
        made.straight(2, (0, 5000, 300), NORTH).commands(1, *rows)
        for at, alive, *who in status:
            made.say(at, "BridgeStatus", VehicleID=(*who, 1)[0], Time=at, Alive=alive)
        return made

    item = "authority over vehicle 1"
    assert one(tmp_path, scene(TAKEN[:7]), item) == expected
    assert one(tmp_path, scene(TAKEN), item) == "holds"
    assert one(tmp_path, scene([*TAKEN[:4], (3000, "command", "UxAS", 0)]), item) == "violated"
    (row,) = [r for r in scene(TAKEN[:7]).judged(tmp_path).rows if r.item == item]
    assert "was never handed back" in row.note
    assert ("declared down at" in row.note) == (expected == "unknown")


# ---- G5 -----------------------------------------------------------------------------------------


def beats(folder: Path, skip=(), status=(), zones=(), instances=(1,), **meta) -> str:
    scene = Scene(instances=list(instances), zones=list(zones))
    scene.meta |= meta
    scene.straight(1, (0, 0, 300), NORTH)
    scene.beats(1, skip)
    for at, alive in status:
        scene.say(at, "BridgeStatus", VehicleID=1, Time=at, Alive=alive)
    found = verdicts(scene.judged(folder))
    both = {v for k, v in found.items() if k.startswith("heartbeat")}
    assert len(both) == 1
    return both.pop()


def test_heartbeats(tmp_path: Path) -> None:
    assert beats(tmp_path) == "holds"
    assert beats(tmp_path, skip=[5]) == "holds"  # two periods, not more
    assert beats(tmp_path, skip=[5, 6]) == "violated"
    assert beats(tmp_path, skip=range(30)) == "violated"
    assert beats(tmp_path, skip=[0, 1, 2]) == "violated"
    assert beats(tmp_path, skip=[18, 19, 20]) == "violated"
    assert beats(tmp_path, instances=[]) == "unknown"


def test_an_instance_that_never_sends_one_is_silent_unless_its_protocol_has_none(
    tmp_path: Path,
) -> None:
    def said(
        *status: tuple[int, bool], command: str = "run m.yaml --processes --original-clients"
    ) -> dict[str, str]:
        scene = Scene(instances=[1]).straight(1, (0, 0, 300), NORTH)
        scene.meta["command"] = command
        for k in range(21):
            beat = {"VehicleID": 1, "Time": 500 * k, "Direction": "Down", "Sequence": k + 1}
            scene.say(500 * k, "Heartbeat", **beat)
        for at, alive in status:
            scene.say(at, "BridgeStatus", VehicleID=1, Time=at, Alive=alive)
        found = verdicts(scene.judged(tmp_path))
        return {k.split()[1]: v for k, v in found.items() if k.startswith("heartbeat")}

    assert said() == {"to": "holds", "from": "unknown"}
    assert said((9000, True)) == {"to": "holds", "from": "unknown"}
    named = "run 'flown --original-clients there/m.yaml' --processes"
    for ours in ("run m.yaml --processes", "", named):
        assert said(command=ours) == {"to": "holds", "from": "violated"}


def test_a_flight_too_short_for_a_heartbeat_to_be_late_holds_nothing(tmp_path: Path) -> None:
    for end_ms, expected in ((1000, "unknown"), (2000, "violated")):
        scene = Scene(end_ms, instances=[1]).straight(1, (0, 0, 300), NORTH)
        found = verdicts(scene.judged(tmp_path))
        assert {v for k, v in found.items() if k.startswith("heartbeat")} == {expected}


def test_a_heartbeat_that_comes_again_or_too_late_is_no_sign_of_life(tmp_path: Path) -> None:
    def said(skip: list[int], extra: list[tuple[int, int]]) -> set[str]:
        scene = Scene(instances=[1]).straight(1, (0, 0, 300), NORTH)
        scene.beats(1, skip)
        for at, number in extra:
            for way in ("Down", "Up"):
                scene.say(at, "Heartbeat", VehicleID=1, Time=at, Direction=way, Sequence=number)
        found = verdicts(scene.judged(tmp_path))
        return {v for k, v in found.items() if k.startswith("heartbeat")}

    assert said([], [(3100, 2), (4100, 7)]) == {"holds"}
    assert said([5, 6, 7], []) == {"violated"}
    assert said([5, 6, 7], [(2600, 2), (3100, 3), (3600, 5)]) == {"violated"}


def test_a_declared_silence_is_safe_or_not(tmp_path: Path) -> None:
    quiet = range(4, 12)
    assert beats(tmp_path, quiet, [(2500, False), (6000, True)]) == "unknown"
    assert beats(tmp_path, quiet, [(9000, False)]) == "violated"  # not about this silence
    there = zone(7, "keep_out", (60, -5), (60, 5), (70, 5), (70, -5))
    assert beats(tmp_path, quiet, [(2500, False)], [there]) == "violated"
    # nobody avoids without the bridge where the gate is not on board
    processes = {"pids": {"uxas": 7}, "ports": {}}
    assert beats(tmp_path, quiet, [(2500, False)], processes=processes) == "violated"
    assert beats(tmp_path, (), (), processes=processes) == "holds"


# ---- the report beside it -------------------------------------------------------------------------


def test_agreement_is_said_and_rows_of_the_plan_are_left_aside(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    rows.append(row("G1", "plan: something", "violated") | {"source": "plan"})
    found = judge(tools.with_report(log, rows))
    assert found.report
    assert not found.differences


def test_disagreement_is_the_first_line(tmp_path: Path, capsys) -> None:
    log, rows = full(tmp_path, lost=True)
    for there in rows:
        if there["requirement"] == "G2":
            there["verdict"] = "holds"
    folder = tools.with_report(log, rows)
    assert main(["judge", str(folder)]) == 1
    out = capsys.readouterr().out
    assert out.startswith("DISAGREEMENT of judge and monitor in 1 rows\n")
    assert "G2 well clear of 1 and 2: judge violated, monitor holds" in out.splitlines()[1]
    assert main(["judge", str(folder / "log.sqlite"), "--json"]) == 1
    data = json.loads(capsys.readouterr().out)
    assert data["disagreements"] == 1
    assert data["differences"][0]["kind"] == "disagree"


def test_a_violation_where_the_monitor_holds_back_only_disagreement_counts(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    for there in rows:
        if there["requirement"] == "G2":
            there["verdict"] = "violated"
    found = judge(tools.with_report(log, rows))
    assert found.of("G2") == "holds"
    assert found.exit_code == 1


def test_excuses_are_listed_and_are_no_disagreement(tmp_path: Path) -> None:
    log, rows = full(tmp_path, lost=True)
    for there in rows:
        if there["requirement"] == "G2":
            there["verdict"] = "excused"
    found = judge(tools.with_report(log, rows))
    assert [d.kind for d in found.differences] == ["claimed excused"]
    assert found.exit_code == 1
    assert not found.disagreements


@pytest.mark.parametrize("gone", ["task 1 served", "end of mission", "authority over vehicle 2"])
def test_a_row_that_the_monitor_leaves_out(tmp_path: Path, gone: str) -> None:
    log, rows = full(tmp_path)
    found = judge(tools.with_report(log, [r for r in rows if r["item"] != gone]))
    assert not found.disagreements  # it holds, so that nothing is hidden
    scene = Scene(tasks=[task(1, "must_fly", (100, 0))]).straight(1, (0, 0, 300), NORTH)
    log = scene.write(tmp_path / "other" / "log.sqlite", end="failed")
    (different,) = [
        d for d in judge(tools.with_report(log, [])).disagreements if d.item == "task 1 served"
    ]
    assert (different.judge, different.monitor) == ("violated", "no row")


def test_a_report_of_another_log(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    folder = tools.with_report(log, rows)
    full(tmp_path, lost=True)
    found = judge(folder)
    assert found.disagreements
    assert found.disagreements[0].note == "the report is about another log"
