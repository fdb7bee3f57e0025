"""Reads the SQLite logs: those of `cratous run`, of the message logger, and UxAS's own `msg`.

A log that is being written, or whose writer was killed, is read up to its last commit. Damage is a
typed error that says how far the log could be read.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from cratous.services.logs.entry import Entry
from cratous.services.logs.schema import COLUMNS, COLUMNS_1, Digest
from cratous.services.logs.store import Gap
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CELL_BYTES, json_of

# the library raises the second where an error message contains a damaged name
ERRORS = (sqlite3.DatabaseError, UnicodeDecodeError)
TABLE_NAMES = "SELECT name FROM sqlite_master WHERE type = 'table'"
"""Names of tables only: the rows of a view may be unbounded."""
UNDECODED, NO_TEXT = "Could not decode to UTF-8", "text that is not UTF-8"
OPTIONAL_KINDS = frozenset((str, type(None)))
_OF_MESSAGE = (int, int, str, str, str)
_WITHOUT_ENVELOPE = (*_OF_MESSAGE, *[type(None)] * 5)
"""Value types of rows written by a flight; other valid rows take the slower check."""


class Closing(NamedTuple):
    """What the writer recorded when it closed the log."""

    messages: int
    digest: str


class TopicCount(NamedTuple):
    """Number of messages of a type in a log; times of the first and the last [ms]."""

    topic: str
    messages: int
    first_ms: int
    last_ms: int


def damaged(path: Path, error: Exception, read: int | None = None) -> BadInput:
    """The error for a log that cannot be read to its end."""
    how_far = "" if read is None else f" after {read} messages"
    # the library's message contains the text itself, of any length
    what = NO_TEXT if str(error).startswith(UNDECODED) else str(error)
    return BadInput(f"the log is damaged{how_far} ({what})", where=str(path))


class SqliteLog:
    """A CRATOUS log open for reading; a context manager."""

    kind = "sqlite"

    def __init__(self, path: Path) -> None:
        """BadInput if the file is not a message log."""
        self.path = path
        self._db = connect(path)
        try:
            self._tables = set(self._column(TABLE_NAMES))
            self._columns = set(self._column("SELECT name FROM pragma_table_info('messages')"))
        except BadInput:
            self.close()
            raise
        if not {"messages", "meta"} <= self._tables:
            self.close()
            raise BadInput(
                "not a message log", where=str(path), expected="tables messages and meta"
            )
        self._names = COLUMNS if "service_id" in self._columns else COLUMNS_1

    def _column(self, query: str) -> list[Any]:
        return [row[0] for row in self._rows(query)]

    def _rows(self, query: str, values: tuple[Any, ...] = ()) -> list[Any]:
        try:
            return self._db.execute(query, values).fetchall()
        except ERRORS as error:
            raise damaged(self.path, error) from None

    def entries(
        self, after: int = -1, where: str = "", values: tuple[Any, ...] = ()
    ) -> Iterator[Entry]:
        """The messages after number `after`, in order; `where` is a further condition in SQL."""
        query = f"SELECT {self._names} FROM messages WHERE seq > ?"
        query += f" AND ({where})" if where else ""
        read = 0
        try:
            for row in self._db.execute(query + " ORDER BY seq", (after, *values)):
                yield entry_of(row)
                read += 1
        except ERRORS as error:
            raise damaged(self.path, error, read) from None

    def meta(self) -> dict[str, Any]:
        """All meta entries as plain data."""
        try:
            rows = self._rows("SELECT key, value FROM meta ORDER BY key")
            return {key: json_of(value, f"{self.path}: {key}") for key, value in rows}
        except (ValueError, TypeError) as error:
            raise damaged(self.path, error) from None

    def topics(self) -> list[TopicCount]:
        """The types in the log with their counts and times."""
        query = "SELECT topic, count(*), min(time_ms), max(time_ms) FROM messages GROUP BY topic"
        found = self._rows(query + " ORDER BY topic")
        return [TopicCount(*self._typed(row, (str, int, int, int))) for row in found]

    def gaps(self) -> list[Gap]:
        """The gaps where the writer had to discard messages."""
        if "gaps" not in self._tables:
            return []
        found = self._rows("SELECT * FROM gaps ORDER BY before_seq")
        return [Gap(*self._typed(row, (int, int, int, int, str))) for row in found]

    @property
    def old(self) -> bool:
        """Whether it is of version 1, which does not record its end."""
        return "closing" not in self._tables

    def closing(self) -> Closing | None:
        """What the writer recorded at its end; None if it is still running, was killed, or is of version 1."""
        if "closing" not in self._tables:
            return None
        rows = self._rows("SELECT messages, digest FROM closing")
        return Closing(*self._typed(rows[-1], (int, str))) if rows else None

    def _typed(self, row: tuple[Any, ...], kinds: tuple[type, ...]) -> tuple[Any, ...]:
        if tuple(map(type, row)) != kinds:
            raise damaged(self.path, ValueError(f"wrong values {row!r:.80}"))
        return row

    def holes(self) -> int:
        """How many numbers are missing between the first and the last."""
        ((count, first, last),) = self._rows("SELECT count(*), min(seq), max(seq) FROM messages")
        return 0 if not count else int(last) - int(first) + 1 - int(count)

    def last_seq(self) -> int:
        """The number of the last message, -1 if there is none."""
        ((last,),) = self._rows("SELECT max(seq) FROM messages")
        return -1 if last is None else int(last)

    def digest(self) -> str:
        """The digest recomputed from the messages."""
        digest = Digest()
        for entry in self.entries():
            digest.feed(entry)
        return digest.hex()

    def verify(self) -> None:
        """BadInput if the database or its messages were altered after writing."""
        for _ in self.verified_entries():
            pass

    def verified_entries(self) -> Iterator[Entry]:
        """All messages; BadInput, after the last of them, if they were altered after writing.

        Results derived from them are valid only once this has ended without an error.
        """
        found = self._column("PRAGMA integrity_check(1)")
        if found != ["ok"]:
            raise damaged(self.path, ValueError(str(found[0])[:200]))
        closing, digest = self.closing(), Digest()
        for entry in self.entries():
            if closing is not None:
                digest.feed(entry)
            yield entry
        if closing is not None and digest.hex() != closing.digest:
            raise BadInput(
                "the messages are not those that were logged",
                where=str(self.path),
                expected=f"digest {closing.digest}",
                got=digest.hex(),
            )

    def close(self) -> None:
        """Close the file."""
        self._db.close()

    def __enter__(self) -> SqliteLog:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()


def entry_of(row: tuple[Any, ...]) -> Entry:
    """The entry of a row; sqlite3.DatabaseError if a value has the wrong type."""
    kinds = tuple(map(type, row))
    if kinds == _WITHOUT_ENVELOPE:
        return tuple.__new__(Entry, row)  # as Entry(*row), in a third of the time
    entry = Entry(*row)
    if kinds == _OF_MESSAGE:
        return entry
    right = type(entry.seq) is type(entry.time_ms) is int
    right = right and type(entry.source) is type(entry.topic) is str
    right = right and type(entry.body) in (str, bytes)
    if not right or not OPTIONAL_KINDS.issuperset(map(type, entry[5:])):
        raise sqlite3.DatabaseError(f"wrong values {row!r:.80}")
    return entry


def connect(path: Path) -> sqlite3.Connection:
    """The database, read-only; BadInput if the file is none."""
    if not path.is_file():
        raise BadInput("there is no such file", where=str(path), expected="a message log (SQLite)")
    try:
        try:
            return _connect(path, "ro")
        except sqlite3.OperationalError:
            # a writer killed at its very end leaves a journal that must be rolled back
            return _connect(path, "rw")
    except sqlite3.OperationalError as error:
        raise BadInput(
            "the log cannot be opened",
            where=str(path),
            expected="a file that can be read; with a -wal file beside it, a folder that can be "
            "written (copy both there)",
            got=str(error),
        ) from None
    except ERRORS:
        raise BadInput("not a message log", where=str(path), expected="SQLite 3") from None


def _connect(path: Path, mode: str) -> sqlite3.Connection:
    database = sqlite3.connect(
        f"{path.resolve().as_uri()}?mode={mode}", uri=True, check_same_thread=False, timeout=10
    )
    try:
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, CELL_BYTES)
        database.execute("PRAGMA trusted_schema = OFF")
        database.execute("PRAGMA query_only = ON")
        database.execute("SELECT name FROM sqlite_master").fetchall()
    except (sqlite3.Error, UnicodeDecodeError):
        database.close()
        raise
    return database


def tables_of(path: Path) -> set[str]:
    """Names of the tables; BadInput if the file is no database."""
    database = connect(path)
    try:
        return {name for (name,) in database.execute(TABLE_NAMES)}
    except ERRORS as error:
        raise damaged(path, error) from None
    finally:
        database.close()
