"""A persistent process that flies one run after another; losses of the process are reported by
kind.

A flight may crash its process, hang, or exhaust memory: that costs the process and one attempt, and
the caller continues. Both communicate by JSON lines; the function that flies is given by its module
and name.
"""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from typing import Any

OUT_OF_MEMORY = "out of memory"
HUNG = "took longer than its limit"
DIED = "its process died"
NO_START = "its process did not start"
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Fliers share the cores, so each uses one thread."""
START = 120.0
"""Time limit for the start of a process [s]."""


class Flier:
    """One process; a context manager. Not for several threads."""

    def __init__(self, function: str, memory_mb: int) -> None:
        """function: `module:name` of the function that is called with a task and returns plain data."""
        self._command = [sys.executable, "-m", __name__, function, str(memory_mb)]
        self._process: subprocess.Popen[bytes] | None = None
        self._said = tempfile.TemporaryFile()  # noqa: SIM115, closed with the flier
        self.version = ""

    def __enter__(self) -> Flier:
        return self

    def __exit__(self, *_error: object) -> None:
        self.end()
        self._said.close()

    @property
    def pid(self) -> int | None:
        """The pid of the current process."""
        return None if self._process is None else self._process.pid

    def fly(self, task: Any, time_s: float) -> dict[str, Any]:
        """`{"result": ...}`, or `{"lost": why}` if the process was lost with this task."""
        lost = self.begin()
        if lost:
            return {"lost": lost}
        assert self._process is not None
        try:
            assert self._process.stdin is not None
            self._process.stdin.write(json.dumps(task).encode() + b"\n")
            self._process.stdin.flush()
        except OSError:
            return {"lost": self._ended(DIED)}
        answer = self._line(time_s)
        if not isinstance(answer, dict):
            return {"lost": self._ended(answer)}
        if "lost" in answer:
            self.end()
        return answer

    def end(self) -> None:
        """End the process, whatever its state."""
        if self._process is None:
            return
        self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                with suppress(OSError):
                    stream.close()
        self._process = None

    def begin(self) -> str:
        """Start a process if there is none, and learn its version; returns the reason if that fails."""
        if self._process is not None and self._process.poll() is None:
            return ""
        self.end()
        from cratous.bridge.text_protocol.keys import without_keys

        self._said.truncate(0)
        self._process = subprocess.Popen(
            self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._said,
            start_new_session=True, env={**without_keys(os.environ), **ONE_THREAD},
        )  # fmt: skip
        hello = self._line(START)
        if not isinstance(hello, dict):
            return self._ended(NO_START)
        self.version = str(hello["version"])
        return ""

    def _line(self, seconds: float) -> dict[str, Any] | str:
        """Its next message, or why there is none."""
        assert self._process is not None
        assert self._process.stdout is not None
        handle, until, parts = self._process.stdout.fileno(), time.monotonic() + seconds, b""
        while not parts.endswith(b"\n"):
            wait = until - time.monotonic()
            if wait <= 0 or not select.select([handle], [], [], wait)[0]:
                return HUNG
            part = os.read(handle, 1 << 20)
            if not part:
                return DIED
            parts += part
        found: dict[str, Any] = json.loads(parts)
        return found

    def _ended(self, why: str) -> str:
        """The reason, with the signal and last output of the process."""
        process = self._process
        if process is None:
            return why
        if why != HUNG:
            with suppress(subprocess.TimeoutExpired):
                code = process.wait(5)
                why += f" (signal {-code})" if code < 0 else f" (exit code {code})"
        self.end()
        self._said.seek(max(0, self._said.seek(0, os.SEEK_END) - 2000))
        lines = self._said.read().decode("utf-8", "replace").split("\n")
        words = next((line.strip() for line in reversed(lines) if line.strip()), "")
        return f"{why}: {words[:200]}" if words and why != HUNG else why


def main(function: str, memory_mb: int) -> None:
    """The process's main loop: print the version, then answer each input line until the input ends."""
    import gc
    import importlib
    import queue
    import threading

    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # all printed output goes to stderr
    _limit_memory(memory_mb)
    from cratous.services.campaign.identity import version_digest

    module, _, name = function.partition(":")
    fly = getattr(importlib.import_module(module), name)
    tasks: queue.Queue[bytes] = queue.Queue()
    # a fork that closes it would wait for the thread that reads it
    asked, sys.stdin = sys.stdin, None

    def read() -> None:
        for line in asked.buffer:
            tasks.put(line)
        os._exit(0)  # the caller is gone, so nobody waits for the result

    _say(answers, {"version": version_digest()})
    threading.Thread(target=read, daemon=True).start()
    gc.set_threshold(100_000, 10, 10)  # as in a command
    loading = True
    while True:
        task = json.loads(tasks.get())
        try:
            answer = {"result": fly(task)}
        except MemoryError:
            answer = {"lost": OUT_OF_MEMORY}
        except OSError as error:
            answer = {"lost": f"the machine failed it: {error.strerror or error}"}
        _say(answers, answer)
        if loading:  # what the first run has loaded stays: exclude it from garbage collection
            gc.freeze()
            loading = False


def _say(answers: Any, data: dict[str, Any]) -> None:
    answers.write(json.dumps(data).encode() + b"\n")
    answers.flush()


def _limit_memory(memory_mb: int) -> None:
    import resource

    size = memory_mb * 1_000_000
    with suppress(ValueError, OSError):  # keep a lower limit of the system
        resource.setrlimit(resource.RLIMIT_DATA, (size, size))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
