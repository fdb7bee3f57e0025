"""A kernel edited by hand: no command that judges or flies goes on, unless it is told to."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from ledger_tools import copied


@pytest.fixture(scope="module")
def edited(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the product in which one kernel differs from what was proved."""
    home = copied(root, tmp_path_factory.mktemp("edited"))
    kernel = home / "cratous" / "core" / "well_clear" / "now.py"
    text = kernel.read_text()
    assert "return abs(sz) <= tcoa_s" in text
    kernel.write_text(text.replace("return abs(sz) <= tcoa_s", "return abs(sz) < tcoa_s"))
    shutil.copy(root / "examples" / "crossing" / "mission.yaml", home)
    return home


def cratous(home: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(home), "PYTHONDONTWRITEBYTECODE": "1"}
    code = f"import sys; sys.path.insert(0, {str(home)!r}); "
    code += "from cratous.services.cli import main; sys.exit(main())"
    return subprocess.run(
        [sys.executable, "-c", code, *words],
        cwd=home,
        env=environment,
        capture_output=True,
        text=True,
        timeout=900,
    )


@pytest.mark.parametrize("command", ["run", "plan"])
def test_an_edited_kernel_is_refused_by_name(edited: Path, command: str) -> None:
    done = cratous(edited, command, "mission.yaml")
    assert done.returncode == 2
    assert "vertical_violation: changed since the proof" in done.stderr
    assert "--allow-unproved" in done.stderr
    assert not (edited / "out").exists()


def test_flown_all_the_same_it_is_never_better_than_unknown(edited: Path) -> None:
    done = cratous(edited, "run", "mission.yaml", "--allow-unproved", "--json")
    assert done.returncode == 3, done.stderr
    assert json.loads(done.stdout)["verdict"] == "unknown"
    page = (edited / "out" / "crossing" / "report.html").read_text()
    assert "--allow-unproved" in page
    assert cratous(edited, "monitor", "out/crossing").returncode == 2
    assert cratous(edited, "monitor", "out/crossing", "--allow-unproved").returncode == 3
