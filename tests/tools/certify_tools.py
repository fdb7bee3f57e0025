"""Results of a flight to edit: their folder, their report, and what their log recorded."""

from __future__ import annotations

import json
import shutil
import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
Run = Callable[..., tuple[int, str, str]]


def edited(flown: Path, tmp_path: Path) -> Path:
    folder = tmp_path / "edited"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(flown, folder)
    return folder


def unconfirmed(flown: Path, tmp_path: Path) -> Path:
    """The same, with a verdict in the report that its log does not give."""
    folder = edited(flown, tmp_path)
    whole = read(folder)
    whole["constraints"][0]["verdict"] = "violated"
    (folder / "report.json").write_text(json.dumps(whole), encoding="utf-8")
    return folder


def read(folder: Path) -> dict[str, Any]:
    return dict(json.loads((folder / "report.json").read_text(encoding="utf-8")))


def proved(folder: Path) -> dict[str, Any]:
    """The report, where the ledger vouches for all kernels."""
    found = read(folder)
    if found["proofs"]["problems"]:
        pytest.skip("a kernel is not proved at present")
    return found


def meta(folder: Path, key: str, value: Any) -> None:
    """Edit (or, with None, forget) what the log recorded; no digest covers it."""
    database = sqlite3.connect(folder / "log.sqlite")
    with database:
        database.execute("DELETE FROM meta WHERE key = ?", (key,))
        if value is not None:
            database.execute("INSERT INTO meta VALUES(?, ?)", (key, json.dumps(value)))
    database.close()
