"""Old machine code leaves the cache; what is not surely ours stays."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from cratous.core.ledger.kept_keys import KEPT
from cratous.core.readings.machine.compiled import folder_name
from cratous.services.cli import main
from cratous.services.startup import prune, warm


def _kept(cache: Path, text: str, days: float) -> Path:
    """A folder of compiled kernels as `load` leaves it, used last so many days ago."""
    folder = cache / folder_name(text)
    (folder / "__pycache__").mkdir(parents=True)
    (folder / f"{folder.name}.py").write_text(text, encoding="utf-8")
    (folder / "__pycache__" / "code.nbc").write_bytes(b"12345")
    _aged(folder, days)
    return folder


def _aged(path: Path, days: float) -> None:
    then_s = time.time() - days * 86_400
    os.utime(path, (then_s, then_s))


def _page(cache: Path, name: str, days: float) -> Path:
    """A file, last written so many days ago."""
    file = cache / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(b"12345")
    _aged(file, days)
    return file


def test_old_machine_code_goes_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(prune, "private_cache", lambda: tmp_path)
    monkeypatch.setattr(warm, "PLANNING", ())
    old, fresh = _kept(tmp_path, "x = 1\n", 8), _kept(tmp_path, "x = 2\n", 6)
    edited, noted = _kept(tmp_path, "x = 3\n", 8), _kept(tmp_path, "x = 4\n", 8)
    (edited / f"{edited.name}.py").write_text("x = 5\n", encoding="utf-8")
    (noted / "notes.txt").write_text("mine", encoding="utf-8")
    elsewhere = _kept(tmp_path / "elsewhere", "x = 6\n", 8)
    link = tmp_path / elsewhere.name
    link.symlink_to(elsewhere)
    (tmp_path / KEPT).mkdir()
    keys = [tmp_path / KEPT / name for name in ("a", "b")]
    for file, days in zip(keys, (8, 6), strict=True):
        file.write_text("{}", encoding="utf-8")
        _aged(file, days)
    pages = [_page(tmp_path, f"pages/{name}", 8) for name in ("a/__jinja2_1.cache", "a/notes.txt")]
    pages += [
        _page(tmp_path, "pages/a/__jinja2_2.cache", 6),
        _page(tmp_path, "b/__jinja2_3.cache", 8),
    ]
    (tmp_path / "pages/b").symlink_to(tmp_path / "b")
    for folder in (edited, noted):
        _aged(folder, 8)
    assert main(["warm", "--planning", "--prune"]) == 0
    assert "3 old parts of the cache removed" in capsys.readouterr().out
    assert not old.exists()
    assert [file.exists() for file in keys] == [False, True]
    assert [file.exists() for file in pages] == [False, True, True, True]
    for kept in (fresh, edited, noted, elsewhere, link):
        assert kept.exists(), kept
    assert main(["warm", "--planning", "--prune", "--days", "0"]) == 0
    assert not fresh.exists()
    assert elsewhere.exists()
