"""Fragments of the changelog are well formed, and moved where they belong."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CHANGELOG = """# Changelog

## 9.9.9 (unreleased)
The next one.

- General.

### Wires

- An old entry.

## 9.9.8

### Proofs

- Done.
"""


@pytest.fixture
def tree(root: Path, tmp_path: Path) -> Path:
    (tmp_path / ".ci").mkdir()
    shutil.copy(root / ".ci" / "changelog", tmp_path / ".ci")
    (tmp_path / "changelog.d").mkdir()
    (tmp_path / "changelog.d" / "README.md").write_text("# no fragment")
    (tmp_path / "CHANGELOG.md").write_text(CHANGELOG)
    return tmp_path


def call(tree: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(tree / ".ci" / "changelog"), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def test_those_of_the_repository_are_well_formed(root: Path) -> None:
    done = call(root)
    assert done.returncode == 0, done.stderr


def test_they_are_moved(tree: Path) -> None:
    (tree / "changelog.d" / "a.md").write_text("section: Wires\n\n- One\n  and the rest.\n- Two.\n")
    (tree / "changelog.d" / "b.md").write_text("- For all.\n")
    assert call(tree, "--write").returncode == 0
    text = (tree / "CHANGELOG.md").read_text()
    assert (
        "\n\n- For all.\n- General.\n\n### Wires\n\n- One\n  and the rest.\n- Two.\n- An old entry.\n"
        in text
    )
    assert text.endswith(CHANGELOG[CHANGELOG.index("## 9.9.8") :])
    assert [f.name for f in (tree / "changelog.d").iterdir()] == ["README.md"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("section: Proofs\n\n- Of a version before.\n", "no section 'Proofs'"),
        ("No entry.\n", "expected an entry"),
        ("- One\nand no indent\n", "neither an entry nor the rest"),
        ("- " + "x" * 130, "longer than 120"),
    ],
)
def test_others_are_refused_and_nothing_is_moved(tree: Path, text: str, said: str) -> None:
    (tree / "changelog.d" / "a.md").write_text(text)
    done = call(tree, "--write")
    assert done.returncode == 1
    assert f"a.md: {said}" in done.stderr
    assert (tree / "CHANGELOG.md").read_text() == CHANGELOG
    assert (tree / "changelog.d" / "a.md").exists()


def test_a_released_version_takes_none(tree: Path) -> None:
    (tree / "CHANGELOG.md").write_text(CHANGELOG.replace(" (unreleased)", ""))
    (tree / "changelog.d" / "a.md").write_text("- One.\n")
    assert "not marked (unreleased)" in call(tree).stderr
