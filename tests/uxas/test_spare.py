"""What a process does before its first request comes: piece by piece, and only when nothing else is there to do."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.services.startup import spare

ROOT = Path(__file__).parents[2]
LOOPS_IN = ("core/geofence", "core/routing", "core/tasks", "services/mission")


@pytest.mark.parametrize("fails", [False, True])
def test_spare_time_is_used_piece_by_piece(tmp_path: Path, fails: bool) -> None:
    ours, said = process(write_cfg(tmp_path, '<Service Type="HelloWorld"/>'))
    done: list[int] = []

    def pieces() -> Iterator[None]:
        for number in range(3):
            done.append(number)
            yield
        ours.stopping = True
        if fails:
            raise OSError("no cache")

    with ours:
        ours.run(10.0, pieces())
        assert ours.stopping
    assert done == [0, 1, 2]
    assert said.has("the first request will take longer: OSError: no cache") == fails


def test_what_is_due_comes_before_a_piece_and_virtual_time_has_none(tmp_path: Path) -> None:
    hello = '<Service Type="HelloWorld" SendPeriod_ms="5"/>'
    for virtual in (False, True):
        folder = tmp_path / str(virtual)
        folder.mkdir()
        ours, _ = process(write_cfg(folder, hello), virtual=virtual)
        done: list[int] = []
        with ours:
            ours.run(0.2, map(done.append, range(3)))
        assert not done


def test_nothing_is_done_ahead_once_something_is_asked_for(tmp_path: Path) -> None:
    ours, _ = process(write_cfg(tmp_path, '<Service Type="HelloWorld"/>'))
    done: list[int] = []

    def pieces() -> Iterator[None]:
        for number in range(9):
            done.append(number)
            if number == 1:
                ours.bus.publish(lmcp.new("TaskAutomationRequest"), "test")
            yield

    with ours:
        ours.run(0.3, pieces())
    assert done == [0, 1]


def test_every_loop_that_planning_may_have_compiled_is_read_ahead() -> None:
    files = [file for folder in LOOPS_IN for file in sorted((ROOT / folder).rglob("*.py"))]
    calls = [
        n for f in files for n in ast.walk(ast.parse(f.read_text())) if isinstance(n, ast.Call)
    ]
    names = {ast.unparse(n.args[0]) for n in calls if ast.unparse(n.func) == "swift"}
    assert names == {loop.__name__ for loop in spare._LOOPS}


def test_the_pieces_plan_what_planning_is_asked_for() -> None:
    assert sum(1 for _ in spare.pieces()) == len(spare._LOOPS) + len(spare.TASKS) + 1
