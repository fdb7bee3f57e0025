"""Messages as text files in the format of UxAS's file logger, for people and for text tools.

Each message is a line `time_ms address$attributes` and its XML. A file holds `limit` messages, a
folder `per_folder` files: `messageLog_0.txt`, or `messageLog_0/messageLog_0.txt` if the number of files is
limited. Each message is flushed to the operating system when written; on a bus it is written once the
messages queued with it are delivered, so a killed process may lose those of its last burst. The
database is the log of record.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import IO

from cratous.services.logs.entry import Entry
from cratous.services.logs.store import cannot_write


class TextFiles:
    """Writes the files; `trouble` says why a message could not be written."""

    def __init__(self, folder: Path, stem: str, limit: int, per_folder: int = 0) -> None:
        """limit: messages in a file, from 1; per_folder: files in a folder, 0 for all in one."""
        self._folder, self._stem = folder, stem
        self._limit, self._per_folder = limit, per_folder
        self._count = 0
        self._file: IO[str] | None = None
        self.lost = 0
        self.trouble = ""

    def path_of(self, number: int) -> Path:
        """The file of message `number`, counted from 0."""
        file = number // self._limit
        folder = self._folder
        if self._per_folder:
            folder = folder / f"{self._stem}_{file // self._per_folder}"
        return folder / f"{self._stem}_{file}.txt"

    def write(self, entry: Entry, xml: str) -> bool:
        """Write one message; False if that fails, and it is counted as lost."""
        number, self._count = self._count, self._count + 1
        try:
            if self._file is None or number % self._limit == 0:
                self._open(number)
            assert self._file is not None
            self._file.write(head_line(entry) + "\n" + xml)
            self._file.flush()
        except OSError as error:
            self.lost += 1
            self.trouble = str(cannot_write(self.path_of(number), error))
            self.close()
            return False
        self.trouble = ""
        return True

    def _open(self, number: int) -> None:
        self.close()
        path = self.path_of(number)
        path.parent.mkdir(parents=True, exist_ok=True)
        self._file = path.open("a", encoding="utf-8", errors="backslashreplace")

    def close(self) -> None:
        """Close the current file."""
        if self._file is not None:
            with suppress(OSError):
                self._file.close()
            self._file = None


def head_line(entry: Entry) -> str:
    """Time, address and attributes of a message."""
    attributes = (
        entry.content_type or "lmcp",
        entry.topic,
        entry.group or "",
        entry.entity_id or "",
        entry.service_id or "",
    )
    return f"{entry.time_ms} {entry.address or entry.topic}${'|'.join(attributes)}$"
