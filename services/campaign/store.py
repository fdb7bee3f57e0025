"""Results in SQLite with a single writer: stored results survive `kill -9`, and are never overwritten."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from cratous.core.files.whole_file import cannot_write
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CELL_BYTES, json_of

NAME = "runs.sqlite"
FORMAT = "cratous-campaign-runs/1"
TABLES = """
CREATE TABLE IF NOT EXISTS format(name TEXT PRIMARY KEY);
CREATE TABLE IF NOT EXISTS runs(id TEXT PRIMARY KEY, result TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS lost(id TEXT NOT NULL, what TEXT NOT NULL);
"""


class Store:
    """The results of runs by id, and the lost attempts; a context manager."""

    def __init__(self, folder: Path) -> None:
        """Open or create it; BadInput if another campaign uses it, or it is not a store."""
        self.path = folder / NAME
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._db = sqlite3.connect(self.path, timeout=0.2, isolation_level=None)
        except (OSError, sqlite3.Error) as error:
            raise cannot_write(self.path, error, "the store of the runs") from None
        try:
            with self._told():
                self._open()
        except BaseException:
            self._db.close()
            raise

    def _open(self) -> None:
        self._db.execute("PRAGMA locking_mode=EXCLUSIVE")
        self._db.execute("PRAGMA synchronous=FULL")
        self._db.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, CELL_BYTES)
        self._db.execute("BEGIN EXCLUSIVE")
        known = self._db.execute("SELECT name FROM sqlite_master WHERE type='table'").fetchall()
        if known and ("format",) not in known:
            raise self._foreign("other tables")
        for statement in TABLES.split(";"):
            self._db.execute(statement)
        found = self._db.execute("SELECT name FROM format").fetchall()
        if not found:
            self._db.execute("INSERT INTO format VALUES(?)", (FORMAT,))
        elif found != [(FORMAT,)]:
            raise self._foreign(str(found[0][0])[:60])
        self._db.execute("COMMIT")

    def _foreign(self, got: str) -> BadInput:
        return BadInput(
            "not a store of runs",
            where=str(self.path),
            expected=f"none, or one of {FORMAT}",
            got=got,
        )

    def __enter__(self) -> Store:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self._db.close()

    def result(self, run: str) -> dict[str, Any] | None:
        """The stored result of a run; None if there is none."""
        with self._told():
            row = self._db.execute("SELECT result FROM runs WHERE id=?", (run,)).fetchone()
        if row is None:
            return None
        found = json_of(row[0], f"{self.path}: run {run[:12]}")
        if not isinstance(found, dict) or not isinstance(found.get("kind"), str):
            raise self._foreign(f"run {run[:12]} is no result")
        return found

    def keep(self, run: str, result: dict[str, Any]) -> None:
        """Store the result of a run; an existing result is kept."""
        text = json.dumps(result, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
        with self._told():
            self._db.execute("INSERT OR IGNORE INTO runs VALUES(?, ?)", (run, text))

    def lose(self, run: str, what: str) -> None:
        """Record a lost attempt at a run, with the reason."""
        with self._told():
            self._db.execute("INSERT INTO lost VALUES(?, ?)", (run, what))

    def lost(self, run: str) -> list[str]:
        """Why attempts at a run were lost, in order."""
        with self._told():
            rows = self._db.execute("SELECT what FROM lost WHERE id=? ORDER BY rowid", (run,))
            return [str(what) for (what,) in rows]

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Convert SQLite errors inside the block to our errors."""
        try:
            yield
        except sqlite3.Error as error:
            with suppress(sqlite3.Error):
                self._db.execute("ROLLBACK")
            if "locked" in str(error):
                raise BadInput(
                    "another campaign writes here", where=str(self.path),
                    expected="one campaign in a folder at a time",
                ) from None  # fmt: skip
            if isinstance(error, sqlite3.DatabaseError) and "not a database" in str(error):
                raise self._foreign("no SQLite file") from None
            raise cannot_write(self.path, error, "the store of the runs") from None
