"""The report on a log alone, whole or not."""

from __future__ import annotations

import json
import shutil
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cratous.services.cli import main

REQUIREMENTS = """trace every 500 ms gap 600 ms
signal altitude: m from AirVehicleState[ID=1].Location.Altitude hold 1 s
requirement FLOOR: altitude >= 90 m
"""


@pytest.fixture
def log(root: Path, tmp_path: Path, fly_once: Callable[[Path], Path]) -> Path:
    shutil.copytree(fly_once(root / "examples" / "crossing" / "mission.yaml"), tmp_path / "flown")
    return tmp_path / "flown" / "log.sqlite"


def _report(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "report.json").read_text())
    return found


def test_of_a_whole_log_it_is_the_report_of_the_flight(log: Path, tmp_path: Path, capsys) -> None:
    assert main(["certify", str(log), "-o", str(tmp_path / "made")]) == 0
    assert _report(tmp_path / "made") == _report(log.parent)
    for name in ("report.html", "map.svg", "log.sqlite"):
        assert (tmp_path / "made" / name).read_bytes() == (log.parent / name).read_bytes()
    assert "not checked: certificate: it is not in the log" in capsys.readouterr().out
    # what is there is not written over
    assert main(["certify", str(log), "-o", str(tmp_path / "made")]) == 2


def test_of_a_log_that_was_cut_it_says_so_and_nothing_in_flight_holds(
    log: Path, tmp_path: Path, capsys
) -> None:
    with sqlite3.connect(log) as database:
        database.execute("DELETE FROM messages WHERE seq > 2000")
        database.execute("DELETE FROM closing")
    made, file = tmp_path / "made", tmp_path / "r.req"
    file.write_text(REQUIREMENTS)
    words = ["certify", str(log), "-o", str(made), "--requirements", str(file), "--json"]
    assert main(words) == 3
    assert json.loads(capsys.readouterr().out)["verdict"] == "unknown"
    report = _report(made)
    assert (report["verdict"], report["exit_code"]) == ("unknown", 3)
    assert report["limits"][0].startswith("The log has no end")
    assert "The log has no end" in (made / "report.html").read_text()
    assert {r["verdict"] for r in report["requirements"]} == {"unknown"}
    in_flight = [row for row in report["constraints"] if row["source"] == "flight"]
    assert in_flight
    assert {row["verdict"] for row in in_flight} == {"unknown"}
    assert report["own"]["requirements"][0]["verdict"] == "unknown"


def test_messages_that_are_missing_within_it_let_nothing_hold(log: Path, tmp_path: Path) -> None:
    """Of one that the writer gave up: the log says how many."""
    with sqlite3.connect(log) as database:
        database.execute("DELETE FROM messages WHERE seq = 100")
        database.execute("INSERT INTO gaps VALUES (100, 1, 3000, 3000, 'disk full')")
        database.execute("DELETE FROM closing")
    assert main(["certify", str(log), "-o", str(tmp_path / "made")]) == 3
    report = _report(tmp_path / "made")
    assert "messages of the log are missing" in " ".join(report["limits"][:2]).lower()
    in_flight = [row for row in report["constraints"] if row["source"] == "flight"]
    assert {row["verdict"] for row in in_flight} == {"unknown"}
    assert {row["state"] for row in report["assumptions"]} == {"not observed"}
    assert any(row["note"].endswith("; else: held") for row in report["assumptions"])


def test_a_changed_log_and_what_is_none_are_refused_by_name(
    log: Path, tmp_path: Path, capsys
) -> None:
    out = ["-o", str(tmp_path / "made")]
    assert main(["certify", str(log)]) == 2
    assert "-o DIR" in capsys.readouterr().err
    assert main(["certify", str(log), *out, "--junit"]) == 2
    half = tmp_path / "half.sqlite"
    half.write_bytes(log.read_bytes()[:300_000])
    assert main(["certify", str(half), *out]) == 2
    assert str(half) in capsys.readouterr().err
    with sqlite3.connect(log) as database:
        database.execute("UPDATE messages SET time_ms = time_ms + 1 WHERE seq = 100")
    assert main(["certify", str(log), *out]) == 2
    assert "digest" in capsys.readouterr().err
    assert not (tmp_path / "made").exists()


def test_a_certificate_alone_is_checked(log: Path, capsys) -> None:
    assert main(["certify", str(log.parent / "certificate.json")]) == 0
    assert "confirmed: optimal" in capsys.readouterr().out


@pytest.mark.parametrize("body", ["{", "{}", "5", "[" * 100_000])
def test_an_acceptance_that_says_no_plan_is_not_that_of_the_plan(
    body: str, log: Path, tmp_path: Path, capsys
) -> None:
    with sqlite3.connect(log) as database:
        database.execute(
            "UPDATE messages SET body = ? WHERE topic = 'cratous.PlanAccepted'", (body,)
        )
        assert database.execute("SELECT changes()").fetchone() == (1,)
        database.execute("DELETE FROM closing")
    assert main(["certify", str(log), "-o", str(tmp_path / "made")]) == 2
    assert str(log) in capsys.readouterr().err
    assert not (tmp_path / "made").exists()


@pytest.mark.parametrize("said", ["7", "[5]", '[{"file": 3}]'])
def test_requirements_that_the_log_does_not_name_rightly_are_told(
    said: str, log: Path, tmp_path: Path, capsys
) -> None:
    with sqlite3.connect(log) as database:
        database.execute("INSERT INTO meta VALUES ('own', ?)", (said,))
    assert main(["certify", str(log), "-o", str(tmp_path / "made")]) == 0
    assert "own: the flight was flown with files that it does not name" in capsys.readouterr().out


def test_another_log_is_not_written_over(log: Path, tmp_path: Path, capsys) -> None:
    """As of a flight that was stopped, and has no report yet."""
    made = tmp_path / "made"
    made.mkdir()
    (made / "log.sqlite").write_bytes(b"of another flight")
    assert main(["certify", str(log), "-o", str(made)]) == 2
    assert "there is another log already" in capsys.readouterr().err
    assert (made / "log.sqlite").read_bytes() == b"of another flight"


def test_of_a_log_that_does_not_say_that_silences_are_told_none_is_said_to_be_missing(
    log: Path,
) -> None:
    """As logs of before: no `UxasHeard` in them says nothing of what ICAROUS heard."""
    from cratous.services.certify.rejudge import watch

    names = ("delivery to ICAROUS", "way back free")
    assert {r["state"] for r in watch(log).assumptions if r["name"] in names} == {"held"}
    with sqlite3.connect(log) as database:
        database.execute("DELETE FROM meta WHERE key = 'uxas_heard'")
    rows = {row["name"]: row for row in watch(log).assumptions}
    for name in names:
        assert rows[name]["state"] == "not observed"
        assert rows[name]["note"] == "this ICAROUS does not say whether it hears UxAS"
