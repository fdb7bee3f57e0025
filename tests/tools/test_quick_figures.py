"""The quick figures: what is timed is the process itself, and a command that ends otherwise is no figure."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def quick() -> ModuleType:
    spec = importlib.util.spec_from_file_location("quick_figures", ROOT / "bench" / "quick.py")
    assert spec is not None
    assert spec.loader is not None
    made = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = made
    spec.loader.exec_module(made)
    return made


def test_a_process_is_timed_with_its_cpu_and_its_exit_code(
    quick: ModuleType, tmp_path: Path
) -> None:
    took = quick.timed(("--help",), tmp_path)
    assert took.code == 0
    assert took.cpu_s > 0
    assert 0 <= took.after_s < took.wall_s


def test_a_command_that_fails_is_no_figure(quick: ModuleType, tmp_path: Path) -> None:
    line = quick.Line("nothing", ("plan", str(tmp_path / "none.yaml")), (0,), 1.0)
    for cold in (False, True):
        with pytest.raises(SystemExit, match="exit code 2, expected"):
            quick.measured(line, 1, cold=cold)


def test_a_cold_command_has_an_empty_cache_of_its_own(
    quick: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    given = []

    def timed(_arguments: tuple[str, ...], folder: Path, cache: Path | None = None) -> Any:
        given.append((cache is not None, cache is None or not cache.exists(), folder))
        return quick.Took(1.0, 1.0, 0.0, 0)

    monkeypatch.setattr(quick, "timed", timed)
    for cold in (False, True):
        quick.measured(quick.Line("any", (), (0,), 1.0), 1, cold=cold)
    assert [one[:2] for one in given] == [(False, True), (True, True)]


def test_the_medians_are_told(quick: ModuleType) -> None:
    runs = [quick.Took(w, w / 2, 0.1, 0) for w in (3.0, 1.0, 2.0)]
    assert quick.row("plan", 1.0, runs) == "| plan | 1 | 2.00 | 1.00 | 0.10 |"
