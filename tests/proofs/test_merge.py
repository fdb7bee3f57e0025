"""Two branches that change two kernels merge, and the gate vouches for what comes of it."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from ledger_tools import RESEAL, check, copied, prove


def _git(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    options = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
    return subprocess.run(
        ["git", *options, *words], cwd=folder, capture_output=True, text=True, timeout=120
    )


CHANGES = {
    "early": ("core/authority/timeliness.py", "return at + margin < planned", "return margin + at < planned"),
    "gate": ("core/authority/gate.py", "Gate(1, gate.epoch + 1, False)", "Gate(1, 1 + gate.epoch, False)"),
    "wind": ("core/routing/wind.py", "most_m_s - ground_m_s", "0 + most_m_s - ground_m_s"),
    "again": ("core/authority/gate.py", "Gate(1, gate.epoch + 1, False)", "Gate(1, gate.epoch + 1 + 0, False)"),
}  # fmt: skip


def _branch(folder: Path, name: str, edit: Callable[[], None]) -> None:
    assert _git(folder, "checkout", "-q", "-b", name, "main").returncode == 0
    edit()
    assert _git(folder, "commit", "-qam", name).returncode == 0


@pytest.fixture(scope="module")
def branches(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scratch clone with a branch for each change of a kernel, its records written anew.

    The changes keep the meaning; the keys are those that `cratous prove` would write, which the slow
    test below runs.
    """
    folder = copied(root, tmp_path_factory.mktemp("clone"))
    assert _git(folder, "init", "-q", "-b", "main").returncode == 0
    (folder / ".gitignore").write_text("__pycache__/\n")
    _git(folder, "add", "-A")
    assert _git(folder, "commit", "-qm", "main").returncode == 0
    for name, (place, old, new) in CHANGES.items():
        file = folder / "cratous" / place

        def edit(file: Path = file, old: str = old, new: str = new) -> None:
            text = file.read_text()
            assert old in text, f"{old!r} is not in {file.name}: this case needs an update"
            file.write_text(text.replace(old, new, 1))
            done = check(folder, RESEAL.format(edit=""))
            assert done.returncode == 0, done.stdout + done.stderr

        _branch(folder, name, edit)
    return folder


def test_branches_that_change_different_kernels_merge_and_pass(branches: Path) -> None:
    """Each of three with each other: no line that one changes is changed by another."""
    assert _git(branches, "checkout", "-q", "-B", "merged", "early").returncode == 0
    for other in ("gate", "wind"):
        merged = _git(branches, "merge", "-q", "--no-edit", other)
        assert merged.returncode == 0, merged.stdout + merged.stderr
    done = check(branches)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "NOT VOUCHED" not in done.stdout


def test_two_branches_that_change_one_kernel_do_not_merge_unseen(branches: Path) -> None:
    assert _git(branches, "checkout", "-q", "-B", "merged", "gate").returncode == 0
    merged = _git(branches, "merge", "-q", "--no-edit", "again")
    _git(branches, "merge", "--abort")
    assert merged.returncode != 0


def test_a_merge_that_took_the_record_of_one_and_the_kernel_of_another_is_refused(
    branches: Path,
) -> None:
    assert _git(branches, "checkout", "-q", "-B", "merged", "gate").returncode == 0
    _git(branches, "checkout", "early", "--", f"cratous/{CHANGES['early'][0]}")
    done = check(branches)
    _git(branches, "reset", "-q", "--hard")
    assert done.returncode == 1
    assert "too_early: changed since the proof: its source" in done.stdout


@pytest.mark.long  # a whole proof
def test_what_was_merged_is_what_a_proof_of_it_writes(branches: Path) -> None:
    assert _git(branches, "checkout", "-q", "-B", "merged", "early").returncode == 0
    assert _git(branches, "merge", "-q", "--no-edit", "wind").returncode == 0
    done = prove(branches, "--check")
    assert done.returncode == 0, done.stdout + done.stderr
