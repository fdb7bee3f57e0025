"""Campaigns that are searched in tests, and how far one is that another process flies."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from cratous.services.cli import main


def loss_found(folder: Path, text: str) -> Path:
    """Where the results are of a search for a loss of well clear, by one run; it has to find one."""
    file, out = folder / "campaign.yaml", folder / "out"
    file.write_text(text)
    arguments = ["--find", "G2", "--budget", "1", "--allow-unproved", "-o", str(out)]
    assert main(["campaign", str(file), *arguments]) == 1
    return out


def stored(folder: Path, beside: bool = True) -> int:
    """How many runs are on disk; beside: while the campaign that writes them holds its lock."""
    how = "?mode=ro&immutable=1" if beside else ""
    try:
        database = sqlite3.connect(f"file:{folder / 'runs.sqlite'}{how}", uri=True)
        return int(database.execute("SELECT count(*) FROM runs").fetchone()[0])
    except sqlite3.Error:
        return 0
