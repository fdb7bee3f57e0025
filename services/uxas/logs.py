"""The loggers of a UxAS process: console and file, each from a minimum severity.

Defaults as in UxAS: the console from WARN, the file `log/log_<start in ms>` from DEBUG; the folder
`log` is in the working directory. A line is `<time> <severity> <text>`.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from cratous.services.loading.uxas_settings import SEVERITIES
from cratous.spec.errors import BadInput
from cratous.spec.files.printable import printable


@contextmanager
def writing_in(folder: Path, what: str) -> Iterator[None]:
    """Convert an OSError in the block into a BadInput that names the operation and asks for a writable folder."""
    try:
        yield
    except OSError as error:
        raise BadInput(
            f"{what} ({error.strerror})",
            where=str(folder),
            expected="a folder that can be written",
        ) from None


class Logs:
    """Console and file logger; call it with a severity and a text."""

    def __init__(
        self,
        console: str = "WARN",
        file: str = "DEBUG",
        folder: Path | None = None,
        *,
        echo: Callable[[str], None] | None = None,
        thread_id: bool = False,
    ) -> None:
        """folder None writes no file. echo prints to the console; the default is stderr."""
        self._levels = {name: k for k, name in enumerate(SEVERITIES)}
        self._console, self._file = self._levels[console], self._levels[file]
        self._echo = echo or _stderr
        self._thread_id = thread_id
        self.path: Path | None = None
        self._out: IO[str] | None = None
        self.counts = dict.fromkeys(SEVERITIES, 0)
        if folder is not None:
            with writing_in(folder, "the log cannot be written"):
                folder.mkdir(parents=True, exist_ok=True)
                self.path = folder / f"log_{time.time_ns() // 1_000_000}"
                self._out = self.path.open("a", encoding="utf-8", buffering=1)

    def __call__(self, severity: str, text: str) -> None:
        """Log one text."""
        level = self._levels[severity]
        self.counts[severity] += 1
        text = printable(text)  # a peer could forge lines, or move the cursor
        if level >= self._console:
            self._echo(f"{severity} {text}")
        if self._out is not None and level >= self._file:
            stamp = time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime())
            milli = time.time_ns() // 1_000_000 % 1000
            thread = f" [{threading.get_ident()}]" if self._thread_id else ""
            try:
                self._out.write(f"{stamp}.{milli:03d}Z{thread} {severity} {text}\n")
            except OSError as error:  # a full disk must not stop the flight
                self._echo(f"ERROR the log file cannot be written any more ({error.strerror})")
                self._out = None

    def close(self) -> None:
        """Close the file."""
        if self._out is not None:
            self._out.close()
            self._out = None


def _stderr(text: str) -> None:
    import sys

    print(text, file=sys.stderr, flush=True)
