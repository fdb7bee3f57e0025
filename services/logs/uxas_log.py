"""UxAS's own message log (`messageLog_*.db3`, table `msg`): reading and writing it.

Columns: id, time_ms (UTC since 1970), descriptor (the type), groupID, entityID, serviceID, xml.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from cratous.services.logs.entry import Entry, to_object
from cratous.services.logs.records import canonical
from cratous.services.logs.sqlite_log import ERRORS, connect, damaged, entry_of
from cratous.services.logs.store import cannot_write
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of

TABLE = """CREATE TABLE msg(id INTEGER PRIMARY KEY, time_ms INTEGER NOT NULL,
descriptor TEXT NOT NULL, groupID TEXT NOT NULL, entityID INTEGER NOT NULL,
serviceID INTEGER NOT NULL, xml BLOB NOT NULL)"""


def read_uxas(path: Path) -> Iterator[Entry]:
    """The messages in order. XML that is no message of a known type is kept as text."""
    from cratous.bridge import lmcp

    database = connect(path)
    read = 0
    query = "SELECT time_ms, descriptor, groupID, entityID, serviceID, xml FROM msg ORDER BY id"
    try:
        for time_ms, descriptor, group, entity, service, xml in database.execute(query):
            text = xml.decode("utf-8", "replace") if isinstance(xml, bytes) else str(xml)
            try:
                (message,) = lmcp.xml.loads(text, f"{path}: message {read}", [])
                body = lmcp.to_json(message)
            except (BadInput, ValueError):
                body = canonical({"$text": text})
            source = f"{entity}/{service}"
            ids = (str(entity), str(service), None)
            yield entry_of((read, time_ms, source, descriptor, body, None, group, *ids))
            read += 1
    except ERRORS as error:
        raise damaged(path, error, read) from None
    finally:
        database.close()


class UxasWriter:
    """Writes a database for tools that read UxAS's log; committed as a whole."""

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._db = sqlite3.connect(path)
            self._db.execute(TABLE)
        except sqlite3.Error as error:
            raise cannot_write(path, error) from None

    def write(self, entry: Entry) -> BadInput | None:
        """Add one message; if it has no XML form, adds nothing and returns the error."""
        from cratous.bridge import lmcp

        try:
            xml = lmcp.xml.dumps(to_object(entry))
        except BadInput as error:
            return error
        numbers = [_number(text) for text in (entry.entity_id, entry.service_id)]
        row = (entry.time_ms, entry.topic, entry.group or "", *numbers, xml)
        try:
            self._db.execute(
                "INSERT INTO msg(time_ms, descriptor, groupID, entityID, serviceID, xml) "
                "VALUES(?, ?, ?, ?, ?, ?)",
                row,
            )
        except sqlite3.Error as error:
            raise cannot_write(self._path, error) from None
        return None

    def close(self) -> None:
        """Commit and close the log."""
        try:
            self._db.commit()
        except sqlite3.Error as error:
            raise cannot_write(self._path, error) from None
        finally:
            with suppress(sqlite3.Error):
                self._db.close()


def _number(text: str | None) -> int:
    return integer_of(text or "0", -(2**63), 2**63 - 1) or 0
