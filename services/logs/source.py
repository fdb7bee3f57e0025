"""Opens a log of any supported format, detected by content: the readers of all `cratous log`
commands.

SQLite of CRATOUS or of UxAS, MCAP of CRATOUS, JSON lines, XML (AMASE), sentinel frames, LMCP
messages.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from cratous.services.logs.entry import Entry
from cratous.services.logs.selection import Selection
from cratous.services.logs.sqlite_log import Closing, SqliteLog, TopicCount, tables_of
from cratous.services.logs.store import Gap
from cratous.services.results.names import LOG_NAME
from cratous.spec.errors import BadInput


class Source:
    """A log open for reading: the interface common to all formats."""

    def __init__(self, path: Path, kind: str, read: Callable[[Path], Iterator[Entry]]) -> None:
        self.path, self.kind, self._read = path, kind, read

    def entries(self, selection: Selection | None = None, after: int = -1) -> Iterator[Entry]:
        """The selected messages, in order; BadInput where the log is damaged."""
        for entry in self._read(self.path):
            if entry.seq > after and (selection is None or selection.keeps(entry)):
                yield entry

    def topics(self) -> list[TopicCount]:
        """The message types with counts and times."""
        found: dict[str, TopicCount] = {}
        for entry in self.entries():
            known = found.get(entry.topic) or TopicCount(entry.topic, 0, 2**62, -(2**62))
            first = min(known.first_ms, entry.time_ms)
            last = max(known.last_ms, entry.time_ms)
            found[entry.topic] = TopicCount(entry.topic, known.messages + 1, first, last)
        return [found[topic] for topic in sorted(found)]

    def meta(self) -> dict[str, Any]:
        """The log's meta data."""
        from cratous.services.logs.mcap_log import read_meta

        return read_meta(self.path)[0] if self.kind == "mcap" else {}

    def gaps(self) -> list[Gap]:
        """What is known to be missing."""
        from cratous.services.logs.mcap_log import read_meta

        return [Gap(*gap) for gap in read_meta(self.path)[1]] if self.kind == "mcap" else []

    def closing(self) -> Closing | None:
        """What the writer recorded when it closed the log; None if the format or the writer has no such record."""
        return None

    def end(self) -> str:
        """What is known about the end of the log, in a sentence; empty if the format has none."""
        return ""

    def holes(self) -> int:
        """How many numbers are missing between the first and the last."""
        return 0

    def verify(self) -> None:
        """BadInput if the log is damaged."""
        for _ in self.verified_entries():
            pass

    def verified_entries(self) -> Iterator[Entry]:
        """All messages; BadInput, at the latest after the last, if they differ from what was
        logged.

        Results derived from them are valid only once this has ended without an error.
        """
        return self.entries()

    def close(self) -> None:
        """Close the file."""

    def __enter__(self) -> Source:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()


class DatabaseSource(Source):
    """A CRATOUS log in SQLite."""

    def __init__(self, path: Path) -> None:
        self._log = SqliteLog(path)
        super().__init__(path, "sqlite", lambda _path: self._log.entries())

    def entries(self, selection: Selection | None = None, after: int = -1) -> Iterator[Entry]:
        where, values = selection.sql() if selection is not None else ("", ())
        found = self._log.entries(after, where, values)
        return found if selection is None else selection.of(found)

    def topics(self) -> list[TopicCount]:
        return self._log.topics()

    def meta(self) -> dict[str, Any]:
        return self._log.meta()

    def gaps(self) -> list[Gap]:
        return self._log.gaps()

    def closing(self) -> Closing | None:
        return self._log.closing()

    def end(self) -> str:
        closing = self._log.closing()
        if closing is not None:
            return f"closed with the digest {closing.digest}"
        if self._log.old:
            return "a log of the first version, which does not say whether it is whole"
        return "no end: it is being written, or its writer was stopped"

    def holes(self) -> int:
        return 0 if "selected" in self._log.meta() else self._log.holes()

    def verified_entries(self) -> Iterator[Entry]:
        return self._log.verified_entries()

    def close(self) -> None:
        self._log.close()


def open_log(path: Path) -> Source:
    """The log in a file (or `log.sqlite` in a folder); BadInput if its format is unknown."""
    path = path / LOG_NAME if path.is_dir() else path
    if not path.is_file():
        raise BadInput("there is no such file", where=str(path), expected="a message log")
    try:
        with path.open("rb") as stream:
            head = stream.read(512)
    except OSError as error:
        raise BadInput("the file cannot be read", where=str(path), got=str(error)) from None
    if head.startswith(b"SQLite format 3\0"):
        if "msg" in tables_of(path) and "messages" not in tables_of(path):
            from cratous.services.logs.uxas_log import read_uxas

            return Source(path, "uxas", read_uxas)
        return DatabaseSource(path)
    return _file(path, head)


def _file(path: Path, head: bytes) -> Source:
    from cratous.services.logs import files, mcap_log

    if mcap_log.is_mcap(head):
        return Source(path, "mcap", mcap_log.read_mcap)
    if head.startswith(b"+=+=+=+="):
        return Source(path, "frames", files.read_frames)
    if head.startswith(b"LMCP"):
        return Source(path, "lmcp", files.read_lmcp)
    text = head.lstrip(b"\xef\xbb\xbf \t\r\n")
    if text.startswith(b"{"):
        return Source(path, "jsonl", files.read_json_lines)
    if text.startswith(b"<"):
        return Source(path, "xml", files.read_xml)
    raise BadInput(
        "not a message log",
        where=str(path),
        expected="SQLite, MCAP, JSON lines, XML, sentinel frames or LMCP messages",
        got=repr(head[:16]),
    )


DOUBTS = {
    "open": "the log has no end: it is being written, or its writer was stopped",
    "lost": "messages of the log are missing",
    "selected": "messages of the log were selected, and the others are not here",
    "cut off": "the flight was cut off: the log stops before its mission ends",
    "unended": "the log has no end of its mission: the flight was cut off, or that message is not here",
}
"""Reasons why a log is incomplete, or a flight was not observed to its end, in words."""
BEGINS, ENDS = "cratous.PlanAccepted", "cratous.MissionEnd"
NO_END = frozenset(("cut off", "unended"))
"""The keys of DOUBTS that concern only how far a flight was observed."""


def doubts(path: Path) -> list[str]:
    """Why a log is incomplete, as keys of DOUBTS; BadInput if it was altered after writing."""
    with open_log(path) as source:
        topics = {entry.topic for entry in source.verified_entries()}
        is_open = bool(source.end()) and source.closing() is None
        is_lost = bool(source.holes() + sum(gap.missing for gap in source.gaps()))
        meta = source.meta()
    is_selected, is_whose = "selected" in meta, "mission" in meta
    is_flight = BEGINS in topics or is_whose
    has_no_end = is_flight and ENDS not in topics and not is_open and not is_selected
    # only the flight itself writes the mission: other writers may start late, stop early or omit
    # messages
    is_cut = has_no_end and is_whose and not is_lost
    so = {"open": is_open, "lost": is_lost, "selected": is_selected, "cut off": is_cut}
    so["unended"] = has_no_end and not is_cut
    return [kind for kind, is_so in so.items() if is_so]
