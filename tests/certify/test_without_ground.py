"""A flight in processes whose assumptions are broken is unknown at best: the theorems are of gates on board."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cratous.services.assumptions.observation_texts import GROUNDLESS
from cratous.services.certify import rejudge
from cratous.services.certify import report as report_module
from cratous.services.certify.report import Flown, Judged, build_report
from cratous.services.cli import main
from cratous.services.cli.run import _show
from cratous.services.logs import log as logs
from cratous.spec.mission.changes import TASK_REMOVED, Change

BROKEN = {
    "name": "commands by the gate alone", "state": "broken", "since_ms": 0, "vehicle": 1,
    "text": "a vehicle gets no command but by its gate", "note": "MissionCommand to vehicle 1",
    "guarantees": ["G4"], "lost": "exactly one commander", "stands": "G1 and G2",
    "observed": None, "bound": None, "unit": "", "checks": 1,
}  # fmt: skip


@pytest.fixture(scope="module")
def folder(root: Path, fly_once: Callable[[Path], Path]) -> Path:
    return fly_once(root / "examples/crossing/mission.yaml")


@pytest.mark.parametrize(
    ("command", "assumptions", "code"),
    [
        ("cratous run crossing.yaml --processes", [BROKEN], 3),
        ("cratous run crossing.yaml --processes", [{**BROKEN, "state": "held"}], 0),
        ("cratous run crossing.yaml --simulator amase://127.0.0.1:5555", [BROKEN], 3),
        ("cratous run crossing.yaml --simulator=amase://127.0.0.1:5555", [BROKEN], 3),
        ("cratous run crossing.yaml", [BROKEN], 0),
        ("cratous run 'missions --processes of may/crossing.yaml'", [BROKEN], 0),
        ("cratous run 'may --processes", [BROKEN], 3),
    ],
)
def test_the_report_of_one_says_so(
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    command: str,
    assumptions: list[dict[str, Any]],
    code: int,
) -> None:
    mission, plan = rejudge.subject(folder / "log.sqlite")
    written = json.loads((folder / "report.json").read_text())
    proofs = {**written["proofs"], "problems": []}
    flown = Flown(command, True, proofs, written["environment"])
    judged = Judged(written["constraints"], assumptions, {})
    report = build_report(mission, plan, judged, folder / "log.sqlite", flown)
    assert {row["verdict"] for row in report["requirements"]} == {"holds"}
    assert (report["exit_code"], report["verdict"]) == (code, "unknown" if code else "holds")
    _show(report, folder)
    assert (GROUNDLESS in capsys.readouterr().out) is bool(code)


def test_the_report_lists_no_task_that_was_withdrawn(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nobody asks for it any more, so that it ended undone is no failure."""
    mission, plan = rejudge.subject(folder / "log.sqlite")
    written = json.loads((folder / "report.json").read_text())
    flown = Flown("", True, written["proofs"], written["environment"])
    gone = min(end["task"] for end in written["flight"]["served"])
    without = replace(mission, changes=(Change(1, TASK_REMOVED, task=gone),))
    judged = Judged(written["constraints"], [], {})
    own = report_module.read_flight

    def undone(*given: Any) -> Any:
        flight = own(*given)
        flight.served[gone]["phase"] = "Failed"
        return flight

    monkeypatch.setattr(report_module, "read_flight", undone)
    report = build_report(without, plan, judged, folder / "log.sqlite", flown)
    listed = {end["task"] for end in written["flight"]["served"]}
    assert {end["task"] for end in report["flight"]["served"]} == listed - {gone}


@pytest.mark.parametrize("more", ["", " --processes"])
def test_so_does_the_monitor_of_its_log(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], more: str
) -> None:
    held = rejudge.watch(folder / "log.sqlite").verdicts
    monkeypatch.setattr(rejudge, "watch", lambda _log: rejudge.Watched(held, [BROKEN], {}, 0))
    meta = {**logs.read_meta(folder / "log.sqlite"), "command": f"cratous run x.yaml{more}"}
    monkeypatch.setattr(logs, "read_meta", lambda _log: meta)
    code = main(["monitor", str(folder), "--allow-unproved"])
    assert (GROUNDLESS in capsys.readouterr().out) is bool(more)
    assert code == (3 if more else 0)
