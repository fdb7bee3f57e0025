"""The documents say what is true: generated ones are up to date, commands and links exist."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from cratous.core import ledger


def test_generated_documents_name_all_that_is_recorded(root: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "docs/tools/generate.py", str(tmp_path)],
        cwd=root,
        capture_output=True,
        text=True,
        timeout=900,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    inventory = (tmp_path / "proof-inventory.md").read_text()
    records = ledger.read()
    assert all(f"| `{name}` |" in inventory for name in records["theorems"])
    assert len(records["theorems"]) > 300
    assert "## Kernels, folds and drivers" in inventory
    assert "KeepAliveExpiration_ms" in (tmp_path / "services.md").read_text()
    assert "# Mutation" in (tmp_path / "mutation.md").read_text()


def _pages() -> list[Path]:
    root = Path(__file__).resolve().parents[2]
    return [*sorted(root.glob("*.md")), *sorted(root.glob("docs/**/*.md"))]


@pytest.mark.parametrize("page", _pages(), ids=lambda p: p.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text()):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target


def test_commands_in_the_readme_exist(root: Path) -> None:
    from cratous.services.cli import main

    text = (root / "README.md").read_text()
    commands = set(re.findall(r"^cratous (\w+)", text, re.MULTILINE))
    assert len(commands) >= 6
    for command in sorted(commands):
        assert main([command, "--help"]) == 0


def test_make_targets_in_the_readme_exist(root: Path) -> None:
    makefile = (root / "Makefile").read_text()
    for target in re.findall(r"^make ([\w-]+)", (root / "README.md").read_text(), re.MULTILINE):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target


def test_no_half_merged_text_is_in_the_tree(root: Path) -> None:
    # the pattern is not written out, or this file would match it
    marks = ["git", "grep", "-l", "-E", "^(" + "<" * 7 + "|" + ">" * 7 + ") "]
    found = subprocess.run(marks, cwd=root, capture_output=True, text=True, timeout=900)
    if found.returncode not in (0, 1):
        pytest.skip("not a git checkout")
    assert found.stdout == ""


def test_no_path_of_one_machine_is_in_the_tree(root: Path) -> None:
    listed = subprocess.run(
        ["git", "ls-files"], cwd=root, capture_output=True, text=True, timeout=900
    )
    if listed.returncode != 0:
        pytest.skip("not a git checkout")
    wrong = []
    for name in listed.stdout.split():
        file = root / name
        if file.suffix in {".png"} or not file.is_file():
            continue
        if re.search(r"/(?:work|home|root)/\w", file.read_text(errors="replace")):
            wrong.append(name)
    assert wrong == []
