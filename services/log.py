"""The message log: SQLite, complete or absent, with a digest that names its content.

`messages` holds every message of the bus in total order; `meta` holds what is needed to judge it
again (mission, plan, version, seed). The digest covers sequence, virtual time, source, topic and
canonical body: no ports, no wall times, no order of insertion. The file is written beside its
final name and renamed when it is whole.
"""

from __future__ import annotations

import hashlib
import json
import os
import sqlite3
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

from cratous.services.bus import Envelope
from cratous.services.records import canonical
from cratous.spec.errors import BadInput

BATCH = 500
_SCHEMA = """
CREATE TABLE messages(seq INTEGER PRIMARY KEY, time_ms INTEGER NOT NULL, source TEXT NOT NULL,
                      topic TEXT NOT NULL, body TEXT NOT NULL);
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL);
"""


class Row(NamedTuple):
    """One logged message; `body` is the canonical JSON text."""

    seq: int
    time_ms: int
    source: str
    topic: str
    body: str


def _feed(digest: Any, row: Row) -> None:
    head = canonical([row.seq, row.time_ms, row.source, row.topic])
    digest.update(f"{head}\n{row.body}\n".encode())


class LogWriter:
    """Writes one log; use as a context manager. An exception inside leaves no file."""

    def __init__(self, path: Path, encode: Callable[[Any], str] | None = None, **meta: Any) -> None:
        """encode(body) gives canonical JSON text; the default is that of LMCP objects."""
        if encode is None:
            from cratous.bridge.lmcp import jsonform

            encode = jsonform.to_json
        self.path = path
        self._encode = encode
        self._part = path.with_name(path.name + ".part")
        self._part.unlink(missing_ok=True)
        self._db = sqlite3.connect(self._part)
        self._db.executescript(_SCHEMA)
        self._rows: list[Row] = []
        self._digest = hashlib.sha256()
        self.count = 0
        for key, value in sorted(meta.items()):
            self.note(key, value)

    def note(self, key: str, value: Any) -> None:
        """Set a meta entry to plain data."""
        self._db.execute("INSERT OR REPLACE INTO meta VALUES(?, ?)", (key, canonical(value)))

    def tap(self, envelope: Envelope) -> None:
        """Log one message; made for `Bus.tap`."""
        row = Row(
            envelope.seq,
            envelope.time_ms,
            envelope.source,
            envelope.topic,
            self._encode(envelope.body),
        )
        _feed(self._digest, row)
        self._rows.append(row)
        self.count += 1
        if len(self._rows) >= BATCH:
            self._flush()

    def digest(self) -> str:
        """SHA-256 over all messages so far, in hexadecimal."""
        return self._digest.hexdigest()

    def _flush(self) -> None:
        self._db.executemany("INSERT INTO messages VALUES(?, ?, ?, ?, ?)", self._rows)
        self._rows.clear()

    def close(self) -> None:
        """Write the rest and give the file its name."""
        self._flush()
        self._db.commit()
        self._db.close()
        os.replace(self._part, self.path)

    def discard(self) -> None:
        """Give up: leave no file."""
        self._db.close()
        self._part.unlink(missing_ok=True)

    def __enter__(self) -> LogWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            self.close()
        else:
            self.discard()


def _open(path: Path) -> sqlite3.Connection:
    if not path.is_file():
        raise BadInput("there is no such file", where=str(path), expected="a message log (SQLite)")
    database = sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)
    try:
        tables = {name for (name,) in database.execute("SELECT name FROM sqlite_master")}
    except sqlite3.DatabaseError:
        database.close()
        raise BadInput("not a message log", where=str(path), expected="SQLite 3") from None
    if not {"messages", "meta"} <= tables:
        database.close()
        raise BadInput("not a message log", where=str(path), expected="tables messages and meta")
    return database


def read_log(path: Path) -> Iterator[Row]:
    """The messages in order; BadInput if the file is not a message log."""
    database = _open(path)
    try:
        query = "SELECT seq, time_ms, source, topic, body FROM messages ORDER BY seq"
        for found in database.execute(query):
            yield Row(*found)
    except sqlite3.DatabaseError as error:
        raise BadInput(f"the log is damaged ({error})", where=str(path)) from None
    finally:
        database.close()


def read_meta(path: Path) -> dict[str, Any]:
    """All meta entries as plain data."""
    database = _open(path)
    try:
        rows = database.execute("SELECT key, value FROM meta ORDER BY key").fetchall()
        return {key: json.loads(value) for key, value in rows}
    except (sqlite3.DatabaseError, ValueError) as error:
        raise BadInput(f"the log is damaged ({error})", where=str(path)) from None
    finally:
        database.close()


def read_digest(path: Path) -> str:
    """The digest recomputed from the file."""
    digest = hashlib.sha256()
    for row in read_log(path):
        _feed(digest, row)
    return digest.hexdigest()


def read_envelopes(path: Path, decode: Callable[[str], Any] | None = None) -> Iterator[Envelope]:
    """The messages as the bus delivered them; decode(text) gives the body back."""
    if decode is None:
        from cratous.bridge.lmcp import jsonform

        decode = jsonform.from_json
    for row in read_log(path):
        yield Envelope(row.seq, row.time_ms, row.source, row.topic, decode(row.body))
