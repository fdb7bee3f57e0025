"""In what two runs differ, held against their recordings, and which runs are not shown together."""

from __future__ import annotations

import json
import shutil
import sqlite3
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from ground_station_tools import ask, serving

from cratous.services.certify.timeline import FlightReader
from cratous.services.cli import main
from cratous.services.ground_station.comparison import (
    KINDS,
    OTHERWISE,
    Said,
    _parting,
    _rows,
    check_comparable,
    comparison,
)
from cratous.services.ground_station.recording import recording
from cratous.services.logs.log import Row
from cratous.spec.errors import BadInput


def _by(found: dict[str, Any]) -> dict[tuple[str, str], dict[str, Any]]:
    rows = {(row["kind"], row["item"]): row for row in found["differences"]}
    assert len(rows) == len(found["differences"])
    return rows


def test_with_and_without_icarous(crossing: Path, crossing_alone: Path) -> None:
    found = comparison(crossing, crossing_alone)
    rows = _by(found)
    takeover = rows["authority", "takeover of vehicle 2"]
    assert takeover["side"] == "only A"
    assert takeover["a"]["time_ms"] == recording(crossing)["takeovers"][0]["from_ms"]
    well_clear = rows["verdict", "G2 Well clear"]
    assert well_clear["side"] == "different"
    assert well_clear["a"]["text"].startswith("holds, ")
    assert well_clear["b"]["text"].startswith("violated, -")
    assert rows["setting", "avoidance"]["a"]["text"] == "true"
    assert rows["task", "task 2 complete"]["side"] == "different"
    assert ("task", "task 1 complete") not in rows
    assert ("verdict", "G3 Completion") not in rows
    # the flights part where ICAROUS takes over
    assert rows["track", "track of 2"]["a"]["time_ms"] == takeover["a"]["time_ms"]


def test_the_other_way_round_each_row_is_mirrored(crossing: Path, crossing_alone: Path) -> None:
    one, two = (
        _by(comparison(*paths))
        for paths in ((crossing, crossing_alone), (crossing_alone, crossing))
    )
    turned = {"only A": "only B", "only B": "only A", "different": "different"}
    assert one.keys() == two.keys()
    for key, row in one.items():
        assert two[key]["side"] == turned[row["side"]], key
        assert (row["a"] is None) == (two[key]["b"] is None), key


def test_every_event_of_one_run_alone_has_a_row(crossing: Path, crossing_alone: Path) -> None:
    found = comparison(crossing, crossing_alone)
    for mine, others, side in (("a", "b", "a"), ("b", "a", "b")):
        elsewhere = [(e["time_ms"], e["vehicle"], e["text"]) for e in found[others]["events"]]
        told = {row[side]["time_ms"] for row in found["differences"] if row[side]}
        for event in found[mine]["events"]:
            if (event["time_ms"], event["vehicle"], event["text"]) not in elsewhere:
                assert event["time_ms"] in told, event


def test_a_run_does_not_differ_from_itself(crossing: Path) -> None:
    found = comparison(crossing, crossing)
    assert found["differences"] == []
    assert found["verdicts_why_none"] == []


def test_without_a_report_it_says_that_verdicts_are_not_compared(
    crossing: Path, crossing_alone: Path
) -> None:
    found = comparison(crossing, crossing_alone / "log.sqlite")
    assert len(found["verdicts_why_none"]) == 1
    assert found["verdicts_why_none"][0].startswith("B: there is no report.json")
    # what is not known is no difference
    assert {row["kind"] for row in found["differences"]}.isdisjoint(
        ("verdict", "verdict in detail")
    )
    assert ("authority", "takeover of vehicle 2") in _by(found)


@contextmanager
def _changed(run: Path, to: Path) -> Iterator[sqlite3.Connection]:
    """The log of a run in a folder of its own, to be changed."""
    shutil.copy(run / "log.sqlite", to / "log.sqlite")
    with sqlite3.connect(to / "log.sqlite") as base:
        yield base
    base.close()


def _meta(base: sqlite3.Connection, key: str) -> Any:
    ((text,),) = base.execute("SELECT value FROM meta WHERE key = ?", (key,))
    return json.loads(text)


def test_another_note_and_another_share_served_of_a_task_are_told(
    crossing: Path, tmp_path: Path
) -> None:
    with _changed(crossing, tmp_path) as base:
        asked = "SELECT seq, body FROM messages WHERE topic = 'cratous.TaskProgress'"
        for seq, text in base.execute(asked).fetchall():
            body = json.loads(text)
            if body["Phase"] == "Complete":
                body |= {"Served": 0.75} if body["TaskID"] == 1 else {"Note": "late"}
                new = json.dumps(body, separators=(",", ":"))
                base.execute("UPDATE messages SET body = ? WHERE seq = ?", (new, seq))
    rows = _by(comparison(crossing / "log.sqlite", tmp_path / "log.sqlite"))
    assert rows.keys() == {("task", "task 1 complete"), ("task", "task 2 complete")}
    one, two = (rows["task", f"task {number} complete"] for number in (1, 2))
    assert one["a"]["text"] == "vehicle 1, 100 % served"
    assert one["b"]["text"] == "vehicle 1, 75 % served"
    assert two["a"]["text"] == "vehicle 2, 100 % served"
    assert two["b"]["text"] == "vehicle 2, 100 % served: late"


def test_what_is_told_of_a_task_again_in_its_phase_is_compared() -> None:
    body = {
        "$type": "CRATOUS/TaskProgress",
        "TaskID": 1,
        "VehicleID": 1,
        "Phase": "Active",
        "Served": 0.5,
    }
    found = []
    for note in ("back on the path", "back"):
        reader = FlightReader([1])
        for k, text in enumerate(("", note)):
            told = json.dumps({**body, "Time": 1000 * k, "Note": text})
            reader.add(Row(k, 1000 * k, "", "cratous.TaskProgress", told))
        flight = reader.finish()
        assert len(flight.events) == len(flight.event_kinds) == 1
        found.append(KINDS["task"]({"phases": flight.phases, "in_phase": flight.in_phase}))
    (row,) = _rows("task", *found)
    assert row["item"] == "task 1 active, told again"
    assert row["a"] == {"text": "vehicle 1, 50 % served: back on the path", "time_ms": 1000}
    assert row["b"] == {"text": "vehicle 1, 50 % served: back", "time_ms": 1000}


@pytest.mark.parametrize("what", ["task 3", "end of mission", "plan accepted, or so"])
def test_a_change_of_the_mission_is_an_event_whatever_its_words(what: str) -> None:
    reader = FlightReader([1])
    body = {
        "$type": "CRATOUS/MissionChange",
        "Time": 5,
        "What": what,
        "Consequence": "planned anew",
    }
    reader.add(Row(1, 5, "", "cratous.MissionChange", json.dumps(body)))
    flight = reader.finish()
    run = {"events": flight.events, "event_kinds": flight.event_kinds}
    assert [said.text for said in KINDS["event"](run)] == [f"{what}: planned anew"]
    assert KINDS["plan"](run) == []


def test_every_event_of_a_flight_is_told_by_its_kind_once(popup: Path) -> None:
    run = recording(popup)
    kinds = Counter(run["event_kinds"])
    assert len(run["events"]) == sum(kinds.values())
    assert kinds["task"] == len(run["phases"])
    assert kinds["end"] == 1
    assert kinds["plan"] == len(KINDS["plan"](run)) > 1
    assert kinds["other"] == len(KINDS["event"](run)) > 1


def test_a_setting_that_one_log_does_not_name_is_only_in_the_other(
    crossing: Path, tmp_path: Path
) -> None:
    with _changed(crossing, tmp_path) as base:
        base.execute("DELETE FROM meta WHERE key = 'avoidance'")
        mission = _meta(base, "mission")
        assert mission.pop("cost") == "MINMAX"
        base.execute("UPDATE meta SET value = ? WHERE key = 'mission'", (json.dumps(mission),))
    whole, less = crossing / "log.sqlite", tmp_path / "log.sqlite"
    for side, rows in (
        ("a", _by(comparison(whole, less))),
        ("b", _by(comparison(less, whole))),
    ):
        assert rows.keys() == {("setting", "avoidance"), ("setting", "mission: cost")}
        for row in rows.values():
            assert row["side"] == f"only {side.upper()}"
            assert row["b" if side == "a" else "a"] is None
        assert rows["setting", "avoidance"][side]["text"] == "true"


def _moved(run: Path, to: Path, **frame: float) -> Path:
    """A copy of the log of a run whose mission has another frame."""
    log = to / "log.sqlite"
    shutil.copy(run / "log.sqlite", log)
    with sqlite3.connect(log) as base:
        ((text,),) = base.execute("SELECT value FROM meta WHERE key = 'mission'")
        mission = json.loads(text)
        mission["frame"].update(frame)
        base.execute("UPDATE meta SET value = ? WHERE key = 'mission'", (json.dumps(mission),))
    return log


def test_missions_of_other_frames_are_refused(
    crossing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    moved = _moved(crossing, tmp_path, latitude_deg=37.2)
    with pytest.raises(BadInput) as error:
        check_comparable(crossing, moved)
    assert error.value.item == "mission.frame"
    assert error.value.where == str(moved)
    assert "37.2" in str(error.value.got)
    assert "37.1" in str(error.value.expected)
    assert main(["serve", str(crossing), str(moved), "--port", "0"]) == 2
    assert "other frames" in capsys.readouterr().err


def test_a_log_without_a_mission_is_refused(
    crossing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "log.sqlite"
    shutil.copy(crossing / "log.sqlite", log)
    with sqlite3.connect(log) as base:
        base.execute("DELETE FROM meta WHERE key = 'mission'")
    assert main(["serve", str(crossing), str(log), "--port", "0"]) == 2
    assert "this log names none" in capsys.readouterr().err


def test_a_mission_is_no_run(
    crossing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission = tmp_path / "mission.yaml"
    mission.write_text("name: x\n")
    for words in ([str(crossing), str(mission)], [str(mission), str(crossing)]):
        assert main(["serve", *words]) == 2
        assert "is a mission" in capsys.readouterr().err


@pytest.mark.slow
def test_the_server_gives_the_page_of_two_and_both_recordings(
    crossing: Path, crossing_alone: Path
) -> None:
    with serving(crossing, crossing_alone) as (_, port):
        assert b'id="differences"' in ask(port, "/").body
        found = ask(port, "/recording.json").data()
        for path in ("/index.html", "/./index.html", "/compare.html", "/live.json"):
            assert ask(port, path).status == 404
    assert found == json.loads(json.dumps(comparison(crossing, crossing_alone)))


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ([10, 20], [10, 30], [("x, number 2", "different", 20, 30)]),
        ([10], [10, 30, 40], [("x, number 2", "only B", None, 30), ("x, number 3", "only B", None, 40)]),
        ([10], [], [("x", "only A", 10, None)]),
        ([10, 20], [10, 20], []),
    ],
)  # fmt: skip
def test_what_comes_several_times_is_paired_by_its_number(
    a: list[int], b: list[int], expected: list[tuple[str, str, int | None, int | None]]
) -> None:
    rows = _rows("event", *([Said("x", "", time, time) for time in side] for side in (a, b)))
    got = [
        (row["item"], row["side"], *(row[k] and row[k]["time_ms"] for k in ("a", "b")))
        for row in rows
    ]
    assert got == expected


def test_what_differs_by_more_than_its_text_is_told_so() -> None:
    (row,) = _rows("route", [Said("x", "2 waypoints", 5, 1)], [Said("x", "2 waypoints", 5, 2)])
    assert row["a"]["text"] == "2 waypoints"
    assert row["b"]["text"] == f"2 waypoints, {OTHERWISE}"


def test_a_track_that_ends_sooner_parts_where_it_ends() -> None:
    long = [[0, 0.0, 0.0, 9.0, 0], [1000, 1.0, 0.0, 9.0, 0]]
    (row,) = _parting({"1": long}, {"1": long[:1]})
    assert row["a"] == {
        "text": "north 1.0 m, east 0.0 m, altitude 9.0 m",
        "time_ms": 1000,
    }
    assert row["b"] == {"text": "its last place", "time_ms": 0}
    assert _parting({"1": long}, {"1": long}) == []
    assert [one["side"] for one in _parting({"1": long}, {"2": long})] == ["only A", "only B"]
