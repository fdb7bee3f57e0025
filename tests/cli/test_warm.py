"""What is compiled before the first request: all that planning calls, once, in another process."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from uxas_tools import write_cfg

from cratous.core.readings import tiered as swift
from cratous.core.readings.machine import compiled
from cratous.services.cli import main
from cratous.services.startup import warm

ROOT = Path(__file__).parents[2]
PLANS = """
import sys
from pathlib import Path
import numba.core.event as event
from cratous.core.readings.tiered import at_once
from cratous.services.startup import warm
from cratous.services.loading import load
from cratous.services.pipeline.plan import make_plan

for _, step in warm.PLANNING:
    step()
mission = load(Path(sys.argv[1]))
with event.install_recorder("numba:compile") as seen, at_once():
    make_plan(mission)
names = {e.data["dispatcher"].py_func.__name__ for _, e in seen.buffer}
print("compiled", sorted(names))
"""


@pytest.mark.slow
def test_planning_compiles_nothing_once_it_is_warm() -> None:
    mission = ROOT / "examples" / "search" / "mission.yaml"
    done = subprocess.run(
        [sys.executable, "-c", PLANS, str(mission)],
        capture_output=True, text=True, check=False, env={**os.environ},
    )  # fmt: skip
    assert done.stdout.splitlines()[-1:] == ["compiled []"], done.stderr


def test_what_is_warm_is_not_warmed_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    did: list[Any] = []
    monkeypatch.setattr(warm, "private_cache", lambda: tmp_path)
    monkeypatch.setattr(warm.ahead, "begin_all", lambda: did.append("begun"))
    monkeypatch.setattr(warm.pending_compilation, "ready", did.append)
    monkeypatch.setattr(warm.ahead, "beside", lambda *call: did.append(call))
    said: list[str] = []
    warm.ensure_planning(said.append)
    later = (["cratous", "warm", "--planning", "--quiet"], warm.BESIDE)
    assert did == ["begun", "routes", "assignment", later]
    assert ["compiled, once" in text for text in said] == [True]
    warm.ensure_planning(said.append)  # the other process has left no mark: it goes on
    assert did[4:] == did[:4]
    (tmp_path / "warm").mkdir()
    warm._mark().touch()
    warm.ensure_planning(said.append)
    assert (len(did), len(said)) == (8, 2)


def test_only_a_configuration_that_plans_has_to_be_warm(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    asked: list[bool] = []
    monkeypatch.setattr(warm, "ensure_planning", lambda say: asked.append(True))
    monkeypatch.chdir(tmp_path)
    for kind, times in (("HelloWorld", 0), ("RoutePlannerVisibilityService", 1)):
        path = write_cfg(tmp_path, f'<Service Type="{kind}"/>')
        assert main(["uxas", "-cfgPath", str(path), "-runUntil", "1", "--virtual-time"]) == 0
        assert len(asked) == times


def test_inside_at_once_the_first_call_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, "machine", lambda function: "machine code")
    monkeypatch.setattr(swift, "_compiled", {})
    assert swift.swift(write_cfg) is write_cfg
    with swift.at_once():
        assert swift.swift(write_cfg) == "machine code"
    swift._compiled.clear()
    assert swift.swift(write_cfg) is write_cfg


@pytest.mark.parametrize("cores", [1, 2, 8])
def test_every_step_of_every_chain_is_taken_and_told(cores: int):
    told: list[str] = []
    warm.compile_all(
        [[("a", time.monotonic), ("b", os.getpid)], [("c", os.getpid)]], cores, told.append
    )
    assert sorted(told) == ["a", "b", "c"]


@pytest.mark.parametrize("cores", [1, 2])
def test_a_step_that_fails_is_not_told_as_done(cores: int):
    told: list[str] = []
    gone = partial(os.rmdir, "no such folder")
    with pytest.raises(FileNotFoundError):
        warm.compile_all([[("a", os.getpid)], [("b", gone)]], cores, told.append)
    assert "b" not in told
