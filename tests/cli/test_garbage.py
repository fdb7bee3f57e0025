"""When a command collects garbage: seldom in one that soon ends, as usual in one that may run for days."""

from __future__ import annotations

import contextlib
import gc
import sys
from pathlib import Path
from typing import Any

import pytest

from cratous.services.cli import main
from cratous.services.cli import run as running
from cratous.services.cli.job import Settings
from cratous.spec.errors import BadInput

CROSSING = Path(__file__).resolve().parents[2] / "examples" / "crossing" / "mission.yaml"


@pytest.mark.parametrize("ends", [None, BadInput("wrong"), KeyboardInterrupt()])
def test_after_a_flight_garbage_is_collected_as_before(
    ends: BaseException | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before, meanwhile = gc.get_threshold(), []

    def fly(*_: object, **_gate: object) -> dict[str, Any]:
        meanwhile.append(gc.get_threshold()[0])
        if ends is not None:
            raise ends
        return {}

    monkeypatch.setattr(running, "run_mission", fly)
    with pytest.raises(type(ends)) if ends is not None else contextlib.nullcontext():
        running.run_one(CROSSING, 0, tmp_path, Settings(), True)
    assert meanwhile == [running.COLLECTED_AT]
    assert gc.get_threshold() == before


@pytest.mark.parametrize(("words", "at"), [(["version"], 1_000_000), (["uxas", "-h"], 100_000)])
def test_a_process_that_may_run_for_days_collects_garbage_more_often(
    words: list[str], at: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    set_to: list[int] = []
    monkeypatch.setattr(gc, "set_threshold", lambda first, *_: set_to.append(first))
    monkeypatch.setattr(sys, "argv", ["cratous", *words])
    assert main() == 0
    assert set_to == [at]
