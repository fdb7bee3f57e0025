"""Follows a SQLite log while it is written: polls for messages after the last one seen."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

from cratous.services.logs.entry import Entry
from cratous.services.logs.selection import Selection
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.spec.errors import BadInput

POLL_S = 0.1
_AT_ONCE = 5_000


def follow_log(
    path: Path,
    selection: Selection,
    *,
    new: bool = False,
    deadline: float | None = None,
    poll_s: float = POLL_S,
) -> Iterator[Entry | None]:
    """The messages as they are committed; None at the end, when the writer has closed the log.

    new: only messages written from now on. deadline: monotonic time [s] at which to end without
    None; BadInput if there is no file by then. The log is reopened at each poll, so that the writer
    is never blocked when it closes.
    """
    last = -1
    seen = False
    while True:
        more = False
        if path.is_file():
            with SqliteLog(path) as log:
                closing = log.closing()
                if new and not seen:
                    last = log.last_seq()
                seen = True
                where, values = selection.sql()
                end = log.last_seq()
                stop = min(end, last + _AT_ONCE)
                more = stop < end
                where = f"seq <= {stop}" + (f" AND {where}" if where else "")
                found = [e for e in log.entries(last, where, values) if selection.keeps(e)]
            last = max(last, stop)
            yield from found
            if closing is not None and not more:
                yield None
                return
        if deadline is not None and time.monotonic() >= deadline:
            if not seen:
                raise BadInput("there is no such file", where=str(path), expected="a log to follow")
            return
        if not more:
            time.sleep(poll_s)
