"""Refusals speak the words of the file, not those of Python; names from outside stay on their line."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cratous import judge as judge_package
from cratous.services.cli import main
from cratous.services.logs.records import from_data
from cratous.services.planning.assign_vectors import _Matrix, _Task
from cratous.spec.errors import BadInput


@pytest.mark.parametrize(
    ("data", "expected", "got"),
    [
        (None, "an object with id, duration_ms, eligible", "null"),
        ({"id": True, "duration_ms": 1, "eligible": []}, "a whole number", "true"),
        ({"id": 1, "duration_ms": "x", "eligible": []}, "a whole number", '"x"'),
        ({"id": 1, "duration_ms": 1, "eligible": None}, "a list", "null"),
        ({"id": 1}, "id, duration_ms, eligible", "none for duration_ms, eligible"),
    ],
)
def test_what_does_not_fit_is_said_in_json(data: Any, expected: str, got: str) -> None:
    with pytest.raises(BadInput) as caught:
        from_data(_Task, data, "tasks[0]")
    assert (caught.value.expected, caught.value.got) == (expected, got)
    assert not any(word in str(caught.value) for word in ("_Task", "None", "True", "NoneType"))


def test_a_list_that_is_none(tmp_path: Path) -> None:
    body = {"vehicles": None, "tasks": [], "cost_matrix": [], "task_relationships": "p1"}
    with pytest.raises(BadInput, match=r"vehicles.*expected a list; got null"):
        from_data(_Matrix, body, "problem")


def test_the_judge_prints_no_control_characters(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = "x\x1b[2J\r\nG2 holds"
    row = SimpleNamespace(guarantee="G1", verdict="violated", item=bad, note=bad)
    other = SimpleNamespace(kind=bad, line=lambda: bad)
    found = SimpleNamespace(
        rows=[row], disagreements=[other], differences=[other], not_covered=[], report=True,
        verdict="violated", exit_code=1, of=lambda _name: "violated",
    )  # fmt: skip
    monkeypatch.setattr(judge_package, "judge", lambda *_: found)
    assert main(["judge", str(tmp_path)]) == 1
    out = capsys.readouterr().out
    assert "\x1b" not in out
    assert not [line for line in out.splitlines() if line.startswith("G2 holds")]
    assert json.dumps("\x1b")[1:-1] in out or "\\x1b" in out


@pytest.mark.parametrize(
    "words",
    [
        ["run", "mission.yaml", "--processes", "--rate", "nan"],
        ["sim", "scenario.xml", "--until", "NaN"],
        ["sim", "scenario.xml", "--listen", "127.0.0.1:0", "--rate", "nan"],
        ["icarous", "--vehicle", "1", "--mission", "mission.yaml", "--wait", "nan"],
        ["monitor", "log.sqlite", "--seconds", "nan"],
        ["warm", "--prune", "--days", "nan"],
        ["log", "follow", "log.sqlite", "--for", "nan"],
        ["log", "replay", "log.sqlite", "--rate", "nan"],
        ["assign", "problem.json", "--seconds", "nan"],
        ["assign", "problem.json", "--gap", "nan"],
        ["daa", "excuse", "two.daa", "--time", "nan"],
        ["daa", "explain", "two.daa", "--time", "nan"],
    ],
)
def test_what_is_no_number_is_in_no_range(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2
    assert "is not a number" in capsys.readouterr().err
