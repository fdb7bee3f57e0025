"""Writes a log while messages arrive: SQLite in WAL mode, batched commits, readable at any moment.

The file gets its name when its tables are complete, so that a log is either absent or readable,
also after `kill -9`. Not yet committed are at most `batch` messages or those of the last `every_s`
seconds; `synchronous=NORMAL` keeps committed data when the process dies, and the database
consistent when the power fails. If the disk is full, messages are held (up to `hold`) and written
when there is room again; discarded messages are counted, keep their numbers and are recorded in
`gaps`.
"""

from __future__ import annotations

import os
import sqlite3
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from cratous.core.files import whole_file
from cratous.services.logs.entry import Entry
from cratous.services.logs.records import canonical
from cratous.services.logs.schema import INSERT, TABLES, Digest
from cratous.spec.errors import BadInput

BATCH = 500
EVERY_S = 0.25
HOLD = 20_000


class Gap(NamedTuple):
    """Messages that are missing before number `before_seq`, and why."""

    before_seq: int
    missing: int
    first_ms: int
    last_ms: int
    reason: str


def cannot_write(path: Path, error: Exception) -> BadInput:
    """The error for a log that cannot be written."""
    return whole_file.cannot_write(path, error, "the log")


class LogStore:
    """A growing log; a context manager. Any thread may write."""

    def __init__(
        self,
        path: Path,
        *,
        batch: int = BATCH,
        every_s: float | None = EVERY_S,
        hold: int = HOLD,
        **meta: Any,
    ) -> None:
        """A new log; BadInput if the file exists or cannot be created.

        every_s: greatest age of an uncommitted message [s]; None commits by number alone.
        """
        self.path, self._batch, self._hold, self._every_s = path, batch, hold, every_s
        self.count = 0  # messages accepted: written, held or discarded
        self.committed = 0  # messages on disk
        self.lost = 0  # messages discarded
        self.trouble = ""  # why the last commit failed, empty if it succeeded
        self._pending: list[Entry] = []
        self._gap: Gap | None = None
        self._last_try = float("-inf")
        self._last_kept = -1
        self._digest = Digest()
        self._lock = threading.Lock()
        self._db = _create(path, meta)
        self._over = threading.Event()
        self._clerk: threading.Thread | None = None
        if every_s is not None:
            self._clerk = threading.Thread(target=self._commit_now_and_then, daemon=True)
            self._clerk.start()

    def write(self, entry: Entry) -> bool:
        """Log one message under the next number. False while the log cannot be written."""
        with self._lock:
            if self._over.is_set():
                raise BadInput("the log is closed", where=str(self.path))
            seq, self.count = self.count, self.count + 1
            if len(self._pending) >= self._hold:
                self._give_up(seq, entry.time_ms)
            else:
                self._pending.append(entry._replace(seq=seq))
            if len(self._pending) >= self._batch and self._may_try():
                self._commit()
            return not self.trouble

    def keep(self, entry: Entry) -> None:
        """Log one message under its own number (copy of a log); BadInput if it cannot be written."""
        with self._lock:
            if entry.seq <= self._last_kept:
                raise BadInput(
                    "the messages are not in order",
                    where=entry.place,
                    expected=f"a number above {self._last_kept}",
                    got=f"{entry.seq}",
                )
            self._last_kept, self.count = entry.seq, self.count + 1
            self._pending.append(entry)
            if len(self._pending) >= self._batch and not self._commit():
                raise cannot_write(self.path, sqlite3.Error(self.trouble))

    def keep_gap(self, gap: Gap) -> None:
        """Record a gap of the log of which this is a copy."""
        with self._lock:
            try:
                self._db.execute("INSERT INTO gaps VALUES(?, ?, ?, ?, ?)", gap)
            except sqlite3.Error as error:
                raise cannot_write(self.path, error) from None

    def note(self, key: str, value: Any) -> None:
        """Set a meta entry to plain data."""
        with self._lock:
            try:
                self._db.execute(
                    "INSERT OR REPLACE INTO meta VALUES(?, ?)", (key, canonical(value))
                )
            except sqlite3.Error as error:
                raise cannot_write(self.path, error) from None

    def flush(self) -> bool:
        """Commit the held messages; False if that failed."""
        with self._lock:
            return self._commit()

    def digest(self) -> str:
        """The digest of the committed messages."""
        return self._digest.hex()

    def close(self) -> None:
        """Commit the remaining messages and record the end; BadInput if they are not on disk."""
        if self._over.is_set():
            return
        self._over.set()
        if self._clerk is not None:
            self._clerk.join()
        with self._lock:
            whole = self._commit()
            try:
                if whole:
                    kept = self.count - self.lost
                    self._db.execute("INSERT INTO closing VALUES(?, ?)", (kept, self.digest()))
                    _make_plain(self._db)
            except sqlite3.Error as error:
                self.trouble = str(error)
            finally:
                with suppress(sqlite3.Error):
                    self._db.close()
            if self.trouble:
                left = len(self._pending)
                raise BadInput(
                    f"the log is not whole: {left + self.lost} of {self.count} messages are lost",
                    where=str(self.path),
                    expected="room on the disk",
                    got=self.trouble,
                )

    def _commit_now_and_then(self) -> None:
        while not self._over.wait(self._every_s):
            with self._lock:
                if self._pending and self._may_try():
                    self._commit()

    def _may_try(self) -> bool:
        # a full disk is retried only occasionally
        pause = self._every_s or EVERY_S
        return not self.trouble or time.monotonic() - self._last_try >= pause

    def _give_up(self, seq: int, time_ms: int) -> None:
        self.lost += 1
        first = time_ms if self._gap is None else self._gap.first_ms
        missing = 1 if self._gap is None else self._gap.missing + 1
        self._gap = Gap(seq + 1, missing, first, time_ms, self.trouble or "too many held")

    def _commit(self) -> bool:
        self._last_try = time.monotonic()
        try:
            self._db.execute("BEGIN IMMEDIATE")
            self._db.executemany(INSERT, self._pending)
            if self._gap is not None:
                self._db.execute("INSERT INTO gaps VALUES(?, ?, ?, ?, ?)", self._gap)
            self._db.execute("COMMIT")
        except sqlite3.Error as error:
            with suppress(sqlite3.Error):
                self._db.execute("ROLLBACK")
            self.trouble = str(error)
            return False
        for entry in self._pending:
            self._digest.feed(entry)
        self.committed += len(self._pending)
        self._pending.clear()
        self._gap, self.trouble = None, ""
        return True

    def __enter__(self) -> LogStore:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.close()
        else:  # the pending error is more informative
            with suppress(BadInput):
                self.close()


def _make_plain(database: sqlite3.Connection) -> None:
    """Remove the -wal file, so that the log can be read on a read-only disk; fails if someone reads."""
    with suppress(sqlite3.OperationalError):
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    for _ in range(20):
        try:
            database.execute("PRAGMA journal_mode = DELETE")
            return
        except sqlite3.OperationalError:
            time.sleep(0.02)


def _create(path: Path, meta: dict[str, Any]) -> sqlite3.Connection:
    """A new database under its name, with tables, in WAL mode."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.unlink(missing_ok=True)
        new = sqlite3.connect(part)
        new.executescript(TABLES)
        rows = [(key, canonical(value)) for key, value in sorted(meta.items())]
        new.executemany("INSERT INTO meta VALUES(?, ?)", rows)
        new.commit()
        # before it has its name: the mode change is unsafe for readers if killed
        new.execute("PRAGMA journal_mode = WAL")
        new.close()
        _give_name(part, path)
        database = sqlite3.connect(path, check_same_thread=False, isolation_level=None)
        database.execute("PRAGMA synchronous = NORMAL")
        return database
    except (OSError, sqlite3.Error) as error:
        for end in ("", "-journal", "-wal", "-shm"):
            with suppress(OSError):
                part.with_name(part.name + end).unlink(missing_ok=True)
        raise cannot_write(path, error) from None


def _give_name(part: Path, path: Path) -> None:
    try:
        os.link(part, path)  # unlike a rename it never replaces a log
    except FileExistsError:
        part.unlink()
        raise BadInput(
            "the log exists already", where=str(path), expected="a new file", got="a file"
        ) from None
    except OSError:  # a file system without hard links
        if path.exists():
            raise
        os.replace(part, path)
        return
    part.unlink()
