"""The quick figures: what is timed is the process itself, and a command that ends otherwise is no figure."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

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
    with pytest.raises(SystemExit, match="exit code 2, expected"):
        quick.measured(line, 1)


def test_the_medians_are_told(quick: ModuleType) -> None:
    runs = [quick.Took(w, w / 2, 0.1, 0) for w in (3.0, 1.0, 2.0)]
    assert quick.row("plan", 1.0, runs) == "| plan | 1 | 2.00 | 1.00 | 0.10 |"
