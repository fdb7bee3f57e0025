"""The message log: SQLite, complete or absent, with a digest that identifies its content.

`messages` holds every message of the bus in total order; `meta` holds what is needed to judge it
again (mission, plan, version, seed); the schema is that of all logs (`services.logs.schema`). The
digest covers sequence, virtual time, source, topic and canonical body, but no ports, wall times or
insertion order. The file is written under a temporary name beside its final one and renamed when
complete. The readers here accept logs of the message logger as well.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from cratous.services.bus import Envelope
from cratous.services.logs.entry import Entry, to_text
from cratous.services.logs.records import canonical
from cratous.services.logs.schema import INSERT, TABLES, Digest
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.services.logs.store import cannot_write
from cratous.spec.errors import BadInput

BATCH = 500


class Row(NamedTuple):
    """One logged message; `body` is the canonical JSON text."""

    seq: int
    time_ms: int
    source: str
    topic: str
    body: str


class LogWriter:
    """Writes one log; use as a context manager. An exception inside leaves no file."""

    def __init__(self, path: Path, encode: Callable[[Any], str] | None = None, **meta: Any) -> None:
        """encode(body) returns canonical JSON text; the default is that of LMCP objects."""
        if encode is None:
            from cratous.bridge.lmcp import jsonform

            encode = jsonform.to_json
        self.path = path
        self._encode = encode
        self._part = path.with_name(path.name + ".part")
        self._rows: list[Entry] = []
        self._digest = Digest()
        self.count = 0
        try:
            self._part.unlink(missing_ok=True)
            self._db = sqlite3.connect(self._part)
            self._db.executescript(TABLES)
        except (OSError, sqlite3.Error) as error:
            raise cannot_write(path, error) from None
        for key, value in sorted(meta.items()):
            self.note(key, value)

    def note(self, key: str, value: Any) -> None:
        """Set a meta entry to plain data."""
        self._execute("INSERT OR REPLACE INTO meta VALUES(?, ?)", (key, canonical(value)))

    def tap(self, envelope: Envelope) -> None:
        """Log one message; intended for `Bus.tap`."""
        entry = Entry(
            envelope.seq,
            envelope.time_ms,
            envelope.source,
            envelope.topic,
            self._encode(envelope.body),
        )
        self._digest.feed(entry)
        self._rows.append(entry)
        self.count += 1
        if len(self._rows) >= BATCH:
            self._flush()

    def digest(self) -> str:
        """SHA-256 over all messages so far, in hexadecimal."""
        return self._digest.hex()

    def _execute(self, statement: str, values: tuple[Any, ...]) -> None:
        try:
            self._db.execute(statement, values)
        except sqlite3.Error as error:
            raise cannot_write(self.path, error) from None

    def _flush(self) -> None:
        try:
            self._db.executemany(INSERT, self._rows)
        except sqlite3.Error as error:
            raise cannot_write(self.path, error) from None
        self._rows.clear()

    def close(self) -> None:
        """Write the remaining messages and give the file its final name."""
        try:
            self._flush()
            self._execute("INSERT INTO closing VALUES(?, ?)", (self.count, self.digest()))
            try:
                self._db.commit()
                self._db.close()
                os.replace(self._part, self.path)
            except (OSError, sqlite3.Error) as error:
                raise cannot_write(self.path, error) from None
        except BaseException:
            self.discard()
            raise

    def discard(self) -> None:
        """Abort: leave no file."""
        with suppress(sqlite3.Error):
            self._db.close()
        with suppress(OSError):
            self._part.unlink(missing_ok=True)
            self._part.with_name(self._part.name + "-journal").unlink(missing_ok=True)

    def __enter__(self) -> LogWriter:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.close()
        else:
            self.discard()


def read_log(path: Path) -> Iterator[Row]:
    """The messages in order; BadInput if the file is not a message log.

    A body logged as LMCP bytes is returned as JSON text.
    """
    with SqliteLog(path) as log:
        for entry in log.entries():
            yield Row(*entry[:4], to_text(entry))


class Heard(NamedTuple):
    """A message of a log with its decoded body, without the rest of its envelope."""

    time_ms: int
    source: str
    topic: str
    body: Any


class Reading:
    """One pass over all messages of a log, bodies as JSON text; `digest` is set at its end, "" before."""

    def __init__(self, path: Path) -> None:
        self.path, self.digest = path, ""

    def __iter__(self) -> Iterator[Entry]:
        digest = Digest()
        with SqliteLog(self.path) as log:
            for entry in log.entries():
                digest.feed(entry)
                if type(entry.body) is str:
                    yield entry
                else:
                    yield entry._replace(body=to_text(entry))
        self.digest = digest.hex()


def read_heard(path: Path) -> Iterator[Heard]:
    """The messages of a log with decoded bodies; BadInput for a body that is invalid or not of its message's type."""
    for row in read_log(path):
        yield Heard(row.time_ms, row.source, row.topic, body_of(row))


def body_of(row: Row | Entry) -> Any:
    """The object of a JSON body; BadInput if it is invalid or not of the type that the message states."""
    from cratous.bridge.lmcp.jsonform import from_json

    try:
        body = from_json(str(row.body))
    except BadInput as error:
        raise BadInput(
            error.what, where=_place(row), item=error.item, expected=error.expected, got=error.got
        ) from None
    names = body.all_names
    if row.topic not in names:
        raise BadInput(
            "a body of another type", where=_place(row), expected=row.topic, got=names[0]
        )
    return body


def _place(row: Row | Entry) -> str:
    return f"message {row.seq} ({row.topic})"


def read_meta(path: Path) -> dict[str, Any]:
    """All meta entries as plain data."""
    with SqliteLog(path) as log:
        return log.meta()


def read_digest(path: Path) -> str:
    """The digest recomputed from the file."""
    with SqliteLog(path) as log:
        return log.digest()


def read_envelopes(path: Path, decode: Callable[[str], Any] | None = None) -> Iterator[Envelope]:
    """The messages as the bus delivered them; decode(text) restores the body."""
    for row in read_log(path):
        yield Envelope(
            row.seq,
            row.time_ms,
            row.source,
            row.topic,
            body_of(row) if decode is None else decode(row.body),
        )
