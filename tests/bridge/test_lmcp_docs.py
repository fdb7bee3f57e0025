"""The Python of docs/reference/lmcp.md runs as it stands."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cratous.bridge.lmcp import model
from cratous.services.cli import main


def test_the_examples_of_the_guide_run(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (root / "docs" / "reference" / "lmcp.md").read_text("utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)
    assert len(blocks) == 3
    monkeypatch.chdir(tmp_path)
    for name in ("OURS", "THEIRS"):
        head = f"<SeriesName>{name}</SeriesName><Namespace>{name.lower()}</Namespace>"
        (tmp_path / f"{name}.xml").write_text(f"<MDM>{head}<StructList/></MDM>")
    space: dict[str, object] = {}
    try:
        for block in blocks:
            exec(compile(block, "docs/reference/lmcp.md", "exec"), space)
        assert {"OURS", "THEIRS"} <= set(model.known())
    finally:
        for name in ("OURS", "THEIRS"):
            if name in model.known():
                model.remove(name)


def test_the_commands_of_the_guide_exist(root: Path) -> None:
    text = (root / "docs" / "reference" / "lmcp.md").read_text("utf-8")
    commands = set(re.findall(r"^cratous lmcp ([a-z]+)", text, re.M))
    assert commands == {"decode", "encode", "describe", "diff", "schema"}
    for command in commands:
        assert main(["lmcp", command, "--help"]) == 0
