"""Requirements of the user's own over a flight that was cut off: none holds, and every view says until when it was looked at."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from certify_tools import ROOT

from cratous.services.attestation.requirements_check import own_faults
from cratous.services.certify.requirement_views import own_constraints
from cratous.services.cli import main
from cratous.services.cli.campaign_flight import _requirement
from cratous.services.logs.log import read_meta
from cratous.services.logs.source import open_log
from cratous.services.logs.store import LogStore
from cratous.services.results.ownership import manifest_text

OWN = """trace every 500 ms gap 600 ms
signal z: m from AirVehicleState[ID=1].Location.Altitude hold 1 s
requirement PAST: historically within 5 s z >= 90 m
requirement AHEAD: z >= 90 m and eventually within 5 s z >= 90 m
requirement DUE: always within 20 s z >= 90 m
requirement LOW: z < 90 m
"""
CUT_MS, UNTIL_MS = 150_200, 150_000
SAID = {
    "PAST": "held at each sample until 150 s, where the flight was cut off; what came after is unseen",
    "AHEAD": "holds so far, until 150 s, where the flight was cut off; what came after is unseen",
    "DUE": "holds so far, until 150 s, where the flight was cut off; what came after is unseen; 261 samples hold and "
    "40 are undecided",
}


@pytest.fixture(scope="module")
def cut(fly_once: Callable[[Path], Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the crossing as it is left by a flight that ends early, as `run --processes` closes its log."""
    flown = fly_once(ROOT / "examples" / "crossing" / "mission.yaml")
    home = tmp_path_factory.mktemp("cut")
    with open_log(flown / "log.sqlite") as log, LogStore(home / "log.sqlite", **log.meta()) as kept:
        for entry in log.entries():
            if entry.time_ms <= CUT_MS and not entry.topic.endswith(".MissionEnd"):
                kept.keep(entry)
    (home / "own.req").write_text(OWN)
    words = ["certify", home / "log.sqlite", "-o", home / "run", "--requirements", home / "own.req"]
    assert main([str(word) for word in words]) == 1
    shutil.copy(flown / "certificate.json", home / "run")
    there = sorted(entry.name for entry in (home / "run").iterdir())
    (home / "run" / "manifest.json").write_text(manifest_text(home / "run", there))
    return home


def test_the_monitor_says_until_when(cut: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["monitor", str(cut / "log.sqlite"), "--requirements", str(cut / "own.req")]
    assert main([*words, "--json", "--allow-unproved"]) == 1
    found = json.loads(capsys.readouterr().out)
    rows = {row["name"]: row for row in found["requirements"]}
    assert {name: row["verdict"] for name, row in rows.items()} == {
        "PAST": "unknown", "AHEAD": "unknown", "DUE": "unknown", "LOW": "violated",
    }  # fmt: skip
    assert {name: rows[name]["so_far"] for name in SAID} == SAID
    assert {row["until_s"] for row in rows.values()} == {UNTIL_MS / 1000}
    assert [one["kind"] for one in found["findings"]] == ["cut off"]
    assert main([*words, "--allow-unproved"]) == 1
    out = capsys.readouterr().out
    assert all(text in out for text in SAID.values())
    assert ": holds" not in out


def test_every_view_of_the_report_says_it(cut: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report: dict[str, Any] = json.loads((cut / "run" / "report.json").read_text())
    rows = {row["requirement"]: row for row in report["own"]["requirements"]}
    assert {name: rows[name]["note"] for name in SAID} == SAID
    assert {row["until_ms"] for row in rows.values()} == {UNTIL_MS}
    assert {rows[name]["verdict"] for name in SAID} == {"unknown"}
    assert {row["verdict"] for row in report["requirements"]} == {"unknown"}
    assert main(["certify", str(cut / "run"), "-o", str(cut / "views")]) == 1, capsys.readouterr()
    for name in ("junit.xml", "report.sarif", "constraints.csv"):
        said = (cut / "views" / name).read_text()
        assert all(text in said for text in SAID.values()), name
    page = (cut / "run" / "report.html").read_text()
    assert all(text in page for text in SAID.values())
    of_campaign = {row["requirement"]: _requirement(row) for row in own_constraints(report)}
    assert of_campaign["PAST"]["until_ms"] == UNTIL_MS
    assert (of_campaign["DUE"]["verdict"], of_campaign["DUE"]["note"]) == ("unknown", SAID["DUE"])


def test_a_report_that_calls_it_held_is_refused(cut: Path) -> None:
    report = json.loads((cut / "run" / "report.json").read_text())
    log = cut / "run" / "log.sqlite"
    meta = read_meta(log)
    assert own_faults(report, meta, log) == ([], 4)
    for key, value in (("verdict", "holds"), ("until_ms", 10**6), ("note", "301 samples hold")):
        row = report["own"]["requirements"][0]
        kept, row[key] = row[key], value
        wrong, _ = own_faults(report, meta, log)
        assert len(wrong) == 1
        assert "PAST" in wrong[0]
        assert key in wrong[0]
        row[key] = kept


def test_a_part_of_a_log_that_names_no_flight_is_not_called_cut_off(cut: Path) -> None:
    from cratous.services.logs.source import doubts

    assert doubts(cut / "log.sqlite") == ["cut off"]
    part = cut / "part.jsonl"
    words = ["log", "export", str(cut / "log.sqlite"), "-o", str(part), "--type", "AirVehicleState"]
    assert main(words) == 0
    assert doubts(part) == []


def test_a_selection_is_not_called_cut_off(cut: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from cratous.services.logs.source import DOUBTS, doubts

    part = cut / "part.sqlite"
    words = ["log", "export", str(cut / "log.sqlite"), "-o", str(part), "--to", "100"]
    assert main(words) == 0
    assert doubts(part) == ["selected"]
    capsys.readouterr()
    assert (
        main(["monitor", str(part), "--requirements", str(cut / "own.req"), "--allow-unproved"])
        == 1
    )
    said = capsys.readouterr().out
    assert "cut off" not in said
    assert DOUBTS["selected"] in said


def test_where_the_format_does_not_tell_a_selection_both_are_named(
    cut: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from cratous.services.logs.source import doubts

    part = cut / "begin.jsonl"
    words = ["log", "export", str(cut / "log.sqlite"), "-o", str(part), "--to", "100"]
    assert main(words) == 0
    assert doubts(part) == ["unended"]
    capsys.readouterr()
    words = ["monitor", str(part), "--requirements", str(cut / "own.req"), "--json"]
    assert main([*words, "--allow-unproved"]) == 1
    found = json.loads(capsys.readouterr().out)
    rows = {row["name"]: row for row in found["requirements"]}
    assert rows["PAST"]["so_far"] == (
        "held at each sample until 100 s, where the log has no end of its mission; what came after is unseen"
    )
    assert {rows[name]["verdict"] for name in SAID} == {"unknown"}
    assert [one["kind"] for one in found["findings"]] == ["unended"]


def test_where_messages_were_lost_the_end_may_be_among_them(cut: Path) -> None:
    from cratous.services.logs.source import doubts
    from cratous.services.logs.store import Gap

    part = cut / "lost.sqlite"
    with open_log(cut / "log.sqlite") as log, LogStore(part, **log.meta()) as kept:
        for entry in log.entries():
            kept.keep(entry)
        kept.keep_gap(Gap(kept.count, 1, CUT_MS, CUT_MS, "the disk was slow"))
    assert doubts(part) == ["lost", "unended"]
