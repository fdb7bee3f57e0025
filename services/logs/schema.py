"""The SQLite schema of all our logs, and how a body enters the digest.

`messages` holds the messages in total order, `meta` what is needed to judge them again, `gaps` what
is known to be missing, `closing` one row if the writer finished: the number of messages and the
digest. A body is JSON text or a blob of LMCP bytes. Version 1 (before the last two tables and the
columns of the envelope) is read as well.
"""

from __future__ import annotations

import hashlib
from functools import lru_cache
from typing import Any

from cratous.services.logs.entry import Entry
from cratous.services.logs.records import canonical

APPLICATION_ID = 0x43524154  # "CRAT", so that `file` can identify a log
VERSION = 2
TABLES = f"""
PRAGMA application_id = {APPLICATION_ID};
PRAGMA user_version = {VERSION};
CREATE TABLE messages(seq INTEGER PRIMARY KEY, time_ms INTEGER NOT NULL, source TEXT NOT NULL,
                      topic TEXT NOT NULL, body NOT NULL, address TEXT, sender_group TEXT,
                      entity_id TEXT, service_id TEXT, content_type TEXT);
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE gaps(before_seq INTEGER NOT NULL, missing INTEGER NOT NULL, first_ms INTEGER NOT NULL,
                  last_ms INTEGER NOT NULL, reason TEXT NOT NULL);
CREATE TABLE closing(messages INTEGER NOT NULL, digest TEXT NOT NULL);
"""
INSERT = "INSERT INTO messages VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
COLUMNS_1 = "seq, time_ms, source, topic, body"
COLUMNS = f"{COLUMNS_1}, address, sender_group, entity_id, service_id, content_type"


NO_ENVELOPE = (None,) * 5


@lru_cache(4096)
def _quoted(text: str) -> str:
    return canonical(text)


class Digest:
    """SHA-256 over messages, without ports, wall times, insertion order and meta data."""

    def __init__(self) -> None:
        self._sum: Any = hashlib.sha256()

    def feed(self, entry: Entry) -> None:
        """Add one message; a header without an envelope has only four parts."""
        outside = entry[5:]
        if outside == NO_ENVELOPE:  # the usual case: the result of `canonical`, computed faster
            head = f"[{entry.seq},{entry.time_ms},{_quoted(entry.source)},{_quoted(entry.topic)}]"
        else:
            head = canonical([*entry[:4], *outside])
        body = entry.body
        if isinstance(body, str):
            self._sum.update(f"{head}\n{body}\n".encode())
        else:
            self._sum.update(b"".join((head.encode(), b"\n", body, b"\n")))

    def hex(self) -> str:
        """The digest so far, in hexadecimal."""
        return str(self._sum.hexdigest())
