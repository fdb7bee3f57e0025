"""The judge on what is no flight: damaged logs, missions and reports that do not fit."""

from __future__ import annotations

import json
import os
import sqlite3
from pathlib import Path

import pytest
from judge_tools import TAKEN, Scene, changed, mission, task, vehicle, verdicts, zone

from cratous.judge import judge
from cratous.services.cli import main
from cratous.spec.errors import BadInput

NORTH = (20.0, 0.0, 0.0)


def one(folder: Path, scene: Scene, item: str) -> str:
    """The verdict on one item."""
    return verdicts(scene.judged(folder))[item]


# ---- bad input ------------------------------------------------------------------------------------


def refused(capsys, *arguments: str) -> dict[str, str]:
    """The typed error of the command line; never a traceback."""
    assert main(["judge", *arguments, "--json"]) == 2
    data = json.loads(capsys.readouterr().out)
    assert data["exit_code"] == 2
    assert data["error"]
    return data


def whole(folder: Path, **more) -> Path:
    return Scene(**more).straight(1, (0, 0, 300), NORTH).write(folder / "log.sqlite")


def test_files_that_are_no_logs(tmp_path: Path, capsys) -> None:
    assert "no such file" in refused(capsys, str(tmp_path / "none"))["error"]
    assert "no such file" in refused(capsys, str(tmp_path))["error"]
    text = tmp_path / "log.sqlite"
    text.write_text("not a database, but long enough to have a header " * 9)
    assert "not a message log" in refused(capsys, str(text))["error"]
    text.write_bytes(b"")
    assert "not a message log" in refused(capsys, str(text))["error"]
    other = tmp_path / "other.sqlite"
    with sqlite3.connect(other) as database:
        database.execute("CREATE TABLE msg(id INTEGER)")
    assert "tables messages and meta" in refused(capsys, str(other))["expected"]
    with sqlite3.connect(other) as database:
        database.execute("CREATE TABLE messages(a)")
        database.execute("CREATE TABLE meta(key, value)")
    assert refused(capsys, str(other))["error"] == "not a message log"


def test_every_truncation_is_refused(tmp_path: Path, capsys) -> None:
    log = whole(tmp_path)
    data = log.read_bytes()
    for size in range(0, len(data), 777):
        log.write_bytes(data[:size])
        refused(capsys, str(log))


def test_damage_anywhere_is_refused_or_changes_nothing(tmp_path: Path) -> None:
    log = whole(tmp_path)
    data = log.read_bytes()
    for place in range(0, len(data), 97):
        log.write_bytes(data[:place] + bytes([data[place] ^ 0x5A]) + data[place + 1 :])
        try:
            judge(log)
        except BadInput:
            continue


@pytest.mark.parametrize(
    "sql",
    [
        "DELETE FROM messages WHERE seq > 5",
        "DELETE FROM messages WHERE seq = 5",
        "UPDATE messages SET time_ms = 'soon' WHERE seq = 5",
        "UPDATE messages SET body = 7 WHERE seq = 5",
        "UPDATE messages SET body = x'4c4d4350' WHERE seq = 5",
        "UPDATE messages SET body = '{\"$type\"' WHERE seq = 5",
        "UPDATE messages SET body = replace(body, '300', '301') WHERE seq = 5",
        "UPDATE messages SET body = '[]' WHERE seq = 5",
        "UPDATE closing SET messages = 'many'",
        "UPDATE closing SET digest = x'00'",
        "UPDATE meta SET value = 'null'",
        "UPDATE meta SET value = x'00'",
        "UPDATE meta SET key = 'nothing'",
    ],
)
def test_a_log_that_was_meddled_with(tmp_path: Path, capsys, sql: str) -> None:
    log = whole(tmp_path)
    with sqlite3.connect(log) as database:
        database.execute(sql)
    refused(capsys, str(log))


HUGE = 10**400


@pytest.mark.parametrize(
    "edit",
    [
        lambda m: m.update(zones=None),
        lambda m: m.update(vehicles={}),
        lambda m: m.update(vehicles=[vehicle(1), vehicle(1)]),
        lambda m: m.update(zones=[zone(1, "keep_off", (0, 0), (0, 1), (1, 0))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (0, 1))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (5, 5), (5, 0), (0, 5))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (0, HUGE), (5, 0))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (0, 1e300), (5, 0))]),
        lambda m: m.update(zones=[zone(1, "keep_in", (0, 0), (0, True), (5, 0))]),
        lambda m: m.update(tasks=[task(1, "tea", (0, 0))]),
        lambda m: m.update(tasks=[task(1, "must_fly")]),
        lambda m: m.update(tasks=[task(HUGE, "must_fly", (0, 0))]),
        lambda m: m.update(tasks=[task(1, "loiter", (0, 0), duration_ms=-1)]),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations="p1 p1"),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations=".(p1 p2)"),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations=".(p1"),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations=".(" * 999 + "p1" + ")" * 999),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations="p1_[9-1]"),
        lambda m: m.update(tasks=[task(1, "must_fly", (0, 0))], relations="p1_[0-" + "9" * 5000 + "]"),
        lambda m: m.update(changes=[changed(0, "task_added", 9)]),
        lambda m: m.update(changes=[changed(0, "earthquake", 9)]),
        lambda m: m["simulation"].update(step_ms=0),
        lambda m: m["frame"].update(latitude_deg=91.0),
        lambda m: m["daa"]["well_clear"].update(dthr_m=-1.0),
        lambda m: m.update(relations=5),
        lambda m: m.update(instances=[1, 99]),
    ],
)  # fmt: skip
def test_a_mission_that_does_not_fit(tmp_path: Path, capsys, edit) -> None:
    scene = Scene().straight(1, (0, 0, 300), NORTH)
    edit(scene.mission)
    data = refused(capsys, str(scene.write(tmp_path / "log.sqlite")))
    assert data["item"] or data["where"]


@pytest.mark.parametrize(
    ("kind", "field", "value"),
    [
        ("TruthState", "North", "far"), ("TruthState", "North", HUGE), ("TruthState", "North", 1e300),
        ("TruthState", "North", None), ("TruthState", "Time", 1.5), ("TruthState", "Time", 2**70),
        ("TruthState", "VehicleID", True), ("TaskProgress", "Phase", "Dancing"),
        ("GateState", "Owner", "Nobody"), ("GateState", "Offered", 1), ("Heartbeat", "Direction", 0),
        ("GatedCommand", "Epoch", "1"),
    ],
)  # fmt: skip
def test_a_message_that_does_not_fit(tmp_path: Path, capsys, kind, field, value) -> None:
    scene = Scene(tasks=[task(1, "must_fly", (100, 0))]).straight(1, (0, 0, 300), NORTH).beats(1)
    scene.does(1, 1, 0, 500).commands(1, *TAKEN)
    next(m for m in scene.messages if m.kind == kind).body[field] = value
    data = refused(capsys, str(scene.write(tmp_path / "log.sqlite")))
    assert kind in data["item"]
    assert field in data["item"]


@pytest.mark.parametrize(
    "report", ["", "[]", "{}", '{"format": "cratous-report/1"}', "[" * 100_000]
)
def test_a_report_that_does_not_fit(tmp_path: Path, capsys, report: str) -> None:
    whole(tmp_path)
    (tmp_path / "report.json").write_text(report)
    refused(capsys, str(tmp_path))


def test_a_report_beyond_all_bounds_is_not_read(tmp_path: Path, capsys) -> None:
    whole(tmp_path)
    with (tmp_path / "report.json").open("wb") as file:
        file.truncate(1 << 40)  # takes no room on the disk
    assert "too large" in refused(capsys, str(tmp_path))["error"]


@pytest.mark.parametrize(
    "text",
    ["", "a: [", "[]", "{name: x}", "&a [*a]", "name: !!python/object:os.system x", "- " * 500_000],
)
def test_a_mission_file_that_does_not_fit(tmp_path: Path, capsys, text: str) -> None:
    file = tmp_path / "mission.yaml"
    file.write_text(text)
    assert refused(capsys, str(whole(tmp_path)), "--mission", str(file))["where"] == str(file)
    refused(capsys, str(whole(tmp_path)), "--mission", str(tmp_path))


def test_a_mission_from_a_pipe_or_device_is_not_waited_for(tmp_path: Path, capsys) -> None:
    pipe = tmp_path / "mission.yaml"
    os.mkfifo(pipe)
    for file in (str(pipe), "/dev/zero"):
        said = refused(capsys, str(whole(tmp_path)), "--mission", file)
        assert said["error"] == "not a regular file"


def test_the_mission_of_a_file(tmp_path: Path) -> None:
    """Paddings as distances, seconds as milliseconds, places in degrees."""
    file = tmp_path / "mission.yaml"
    file.write_text("""
name: file
frame: {latitude_deg: 45, longitude_deg: 7}
vehicles: [{id: 1, speed_m_s: 20, heading_deg: 0, position: {north_m: 0, east_m: 0, alt_m: 300}}]
tasks: [{id: 1, kind: must_fly, points: [{latitude_deg: 45.0009, longitude_deg: 7}]}]
zones: [{id: 7, kind: keep_out, padding_m: 10, vertices: [[90, 9], [90, 50], [110, 50], [110, 9]]}]
simulation: {step_ms: 1000}
changes: [{at_s: 7, zone: {id: 8, kind: keep_out, vertices: [[90, -5], [90, 5], [110, 5]]}}]
""")
    scene = Scene().straight(1, (0, 0, 300), NORTH).does(1, 1, 4000, 6000)
    found = verdicts(judge(scene.write(tmp_path / "log.sqlite"), file))
    assert found["zone: keep_out 7, flight of vehicle 1"] == "violated"
    assert found["zone: keep_out 8, flight of vehicle 1"] == "holds"
    assert found["task 1 served"] == "holds"
    # what one vehicle is commanded to do asks for nothing more or less
    text = file.read_text(encoding="utf-8").replace(
        "changes: [",
        "changes: [{at_s: 2, vehicle_holds: {vehicle: 1}}, {at_s: 3, vehicle_resumes: 1}, ",
    )
    file.write_text(text, encoding="utf-8")
    assert verdicts(judge(tmp_path / "log.sqlite", file)) == found


def test_a_mission_that_asks_for_nothing_is_unknown(tmp_path: Path) -> None:
    found = Scene(vehicles=[vehicle(1, protected=False)]).judged(tmp_path)
    assert [found.of(g) for g in ("G1", "G2", "G4", "G5")] == ["unknown"] * 4
    assert found.exit_code == 3
    assert mission()["tasks"] == []
