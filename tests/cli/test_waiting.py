"""What takes long is told on stderr: a bar on a terminal, lines elsewhere, nothing where it is quick."""

from __future__ import annotations

import io
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from cratous.services.cli import main, progress
from cratous.services.cli.job import planning_told
from cratous.services.cli.progress import Waiting, waiting
from cratous.services.logs.log import LogWriter
from cratous.services.trace_replay import files
from cratous.spec.errors import BadInput


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE_S", 0.05)
    monkeypatch.setattr(progress, "BETWEEN_S", 0.01)


def _until(stream: io.StringIO, text: str) -> None:
    """Wait for the thread; that it never says this is a failure."""
    end = time.monotonic() + 120
    while text not in stream.getvalue():
        assert time.monotonic() < end, stream.getvalue()
        time.sleep(0.01)


def test_lines_where_there_is_no_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)
    with waiting("reading\x1b[31m") as wait:
        _until(stream, "reading\\x1b[31m\n")
        for number in wait.each([1, 2], "steps"):
            _until(stream, f"steps: {number} of 2\n")
        wait.at("messages", 7)
        _until(stream, "messages: 7\n")
    assert "\x1b" not in stream.getvalue()


def test_a_bar_on_a_terminal_goes_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = Terminal()
    monkeypatch.setattr("sys.stderr", stream)
    with waiting("reading") as wait:
        wait.at("steps", 1, 4)
        _until(stream, "[######..................] steps: 1 of 4")
    assert stream.getvalue().endswith("\r\x1b[2K")


def test_nothing_is_said_of_what_is_quick_or_quiet(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = Terminal()
    monkeypatch.setattr("sys.stderr", stream)
    with waiting("reading", quiet=True):
        time.sleep(0.2)
    monkeypatch.setattr(progress, "PATIENCE_S", 60.0)
    with pytest.raises(ValueError, match="out"), waiting("reading"):
        raise ValueError("out")
    assert stream.getvalue() == ""


def test_planning_tells_how_far_it_is() -> None:
    wait = Waiting("")
    tap = planning_told(wait.at, 2)
    said = [wait.text()]
    ask, answer, options = "RoutePlanRequest", "RoutePlanResponse", "TaskPlanOptions"
    for name in (ask, options, answer, options, ask, ask, answer, "AssignmentCostMatrix"):
        tap(SimpleNamespace(topic=f"uxas.messages.task.{name}"))
        said.append(wait.text())
    assert said == [
        "planning the options of the tasks: 0 of 2",
        "planning the options of the tasks: 0 of 2",
        "planning the options of the tasks: 1 of 2",
        "planning the options of the tasks: 1 of 2",
        "planning the ways between the tasks",
        "planning the ways between the tasks: 0 of 1",
        "planning the ways between the tasks: 0 of 2",
        "planning the ways between the tasks: 1 of 2",
        "searching for the best assignment",
    ]


def test_other_commands_tell_what_they_do(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As below: the work is held up until the line is there."""
    stream = io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)
    scenario = root / "examples" / "cordon" / "scenario.xml"
    waits = iter(
        ("searching the design safe", "playing trace.json", "flying the scenario", "reading files: 1 of 1",
         "reading the files")
    )  # fmt: skip

    def held(*_args: object, **_more: object) -> None:
        _until(stream, next(waits))
        raise BadInput("held up", expected="", got="")

    monkeypatch.setattr("cratous.proofs.system_search.breadth_first.search", held)
    monkeypatch.setattr(files, "read", lambda _: files.Trace("safe", "as it runs", "", ()))
    monkeypatch.setattr("cratous.services.trace_replay.play.play", held)
    monkeypatch.setattr("cratous.services.simulator.world.World.tick", held)
    monkeypatch.setattr("cratous.services.cli.check._read", held)
    monkeypatch.setattr("cratous.services.importing.gathering.gathered", held)
    for arguments in (
        ["search-faults", "safe"], ["replay-trace", "trace.json"], ["sim", str(scenario)],
        ["check", "plan.algebra"], ["import", str(scenario)],
    ):  # fmt: skip
        assert main(arguments) == 2
    assert next(waits, None) is None


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["judge"], "judging the flight from its log"),
        (["log", "list"], "counting its messages"),
        (["log", "export", "-o", "out.jsonl"], "writing out.jsonl"),
    ],
)
def test_commands_that_read_a_log_tell_what_they_do(
    arguments: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The work is held up until the line is there, so a command that says nothing fails here."""
    stream = io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.chdir(tmp_path)
    log = tmp_path / "log.sqlite"
    LogWriter(log, mission="m").close()
    called: list[str] = []

    def held(*_args: object, **_more: object) -> None:
        _until(stream, told)
        called.append(told)
        raise BadInput("held up", expected="", got="")

    monkeypatch.setattr("cratous.services.cli.judge.PATIENCE_S", 0.05)
    monkeypatch.setattr("cratous.judge.judge", held)
    monkeypatch.setattr("cratous.services.cli.log._missing", held)
    monkeypatch.setattr("cratous.services.logs.export.export", held)
    assert main([*arguments, str(log)]) == 2
    assert called == [told]
