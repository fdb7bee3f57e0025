"""A child process that communicates by JSON objects, one per line: it flies or plans for a page."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any


class JsonProcess:
    """Starts immediately. Its messages are delivered from one thread, in order."""

    def __init__(
        self,
        module: str,
        heard: Callable[[dict[str, Any], str], None],
        ended: Callable[[str], None],
        *words: str,
    ) -> None:
        """module, words: arguments of `python -m`; heard: called with each object and its line;
        ended: called at the end with the signal or exit code.
        """
        self._heard, self._ended = heard, ended
        self._saying = threading.Lock()
        self._process = subprocess.Popen(
            [sys.executable, "-m", module, *words],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8",
        )  # fmt: skip
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            try:
                told = json.loads(line)
            except ValueError:
                break  # cut off in the middle of a line
            self._heard(told, line)
        code = self._process.wait()
        self._ended(f"signal {-code}" if code < 0 else f"exit code {code}")

    def say(self, asked: dict[str, Any]) -> None:
        """Send an object; no effect if the process has ended, which `ended` reports."""
        assert self._process.stdin is not None
        with self._saying, suppress(OSError, ValueError):
            self._process.stdin.write(json.dumps(asked) + "\n")
            self._process.stdin.flush()

    def end(self, patience_s: float) -> None:
        """Close its stdin, which asks it to end; kill it after patience_s seconds."""
        assert self._process.stdin is not None
        with self._saying, suppress(OSError):
            self._process.stdin.close()
        try:
            self._process.wait(patience_s)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
