"""Subprocesses of the program: started, monitored and ended by pid."""

from __future__ import annotations

import os
import random
import signal
import socket
import subprocess
import sys
import time
from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType, TracebackType

import cratous
from cratous.bridge.port import is_due
from cratous.bridge.text_protocol.keys import without_keys
from cratous.services.processes.leash import AT_ONCE, ENDS_WITH
from cratous.services.results.undisturbed import undisturbed
from cratous.spec.errors import CratousError

GRACE_S = 5.0
"""Time between SIGTERM and SIGKILL [s]."""
LAST_LINES = 8
LOWEST, MOST_TRIED = 10_000, 100
"""Of free ports: the lowest one, and how many are tried at most."""
_GIVEN: deque[int] = deque(maxlen=64)


class ProcessEnded(CratousError):
    """A process of the flight has ended prematurely. name: of the process; code: exit code, negative for a
    signal; lines: its last output lines.
    """

    exit_code = 3

    def __init__(self, name: str, code: int, lines: tuple[str, ...]) -> None:
        self.name, self.code, self.lines = name, code, lines
        super().__init__(f"{self.told()}; its last lines: {' | '.join(lines) or 'none'}")

    def told(self) -> str:
        """The process that ended, and its exit code or signal, in words."""
        how = f"exit code {self.code}"
        if self.code not in range(256):
            how = f"signal {signal.Signals(-self.code).name}"
        return f"the process {self.name} has ended before its time ({how})"


def free_port() -> int:
    """A loopback port on which no process is listening, outside of the range from which the system chooses ports
    (where Linux tells it): no other program's connection takes it before a process listens there. It is none of those
    that were returned last, on which a process may be about to listen.
    """
    for _ in range(MOST_TRIED):
        with suppress(OSError), socket.create_server(("127.0.0.1", _unassigned())) as probe:
            port = int(probe.getsockname()[1])
            if port not in _GIVEN:
                _GIVEN.append(port)
                return port
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return int(probe.getsockname()[1])


def _unassigned() -> int:
    """A port below the range from which the system chooses; 0, its own choice, where there is no such range."""
    try:
        first = int(Path("/proc/sys/net/ipv4/ip_local_port_range").read_text().split()[0])
    except (OSError, ValueError, IndexError):
        return 0
    return random.SystemRandom().randrange(LOWEST, first) if first > LOWEST else 0


class Children:
    """The processes of one flight; leaving the context ends all that still run. logs: folder for their
    output, as NAME.txt; work: their working directory.
    """

    def __init__(self, logs: Path, work: Path) -> None:
        self._logs, self._work = logs, work
        place = str(Path(cratous.__file__).absolute().parents[1])
        paths = [place, *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
        self._environment = {
            **without_keys(os.environ),  # bridge keys are passed explicitly, see `start`
            "PYTHONUNBUFFERED": "1",
            # the same program in any working directory
            "PYTHONPATH": os.pathsep.join(path for path in paths if path),
            ENDS_WITH: str(os.getpid()),
        }
        self.running: dict[str, subprocess.Popen[bytes]] = {}

    def __enter__(self) -> Children:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        with undisturbed():  # a second interrupt must not leave processes behind
            self.end()

    def start(
        self,
        name: str,
        *arguments: str,
        may_stand: bool = False,
        private: Mapping[str, str] = MappingProxyType({}),
    ) -> int:
        """Start `cratous` with arguments; returns the pid. may_stand: it may be stopped (SIGSTOP) when this
        process is killed; private: environment variables for this process only.
        """
        environment = {**self._environment, **private}
        environment[ENDS_WITH] += AT_ONCE * may_stand
        with (self._logs / f"{name}.txt").open("wb") as said:
            child = subprocess.Popen(
                [sys.executable, "-m", "cratous", *arguments],
                cwd=self._work,
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=subprocess.STDOUT,
                env=environment,
                # Ctrl-C reaches only this command, which then ends them in order
                start_new_session=True,
            )
        self.running[name] = child
        return child.pid

    def said(self, name: str) -> str:
        """The output of a process so far."""
        return (self._logs / f"{name}.txt").read_text(encoding="utf-8", errors="replace")

    def watch(self) -> None:
        """ProcessEnded if one of them has ended."""
        for name, child in self.running.items():
            code = child.poll()
            if code is not None:
                lines = deque(self.said(name).splitlines(), LAST_LINES)
                raise ProcessEnded(name, code, tuple(lines))

    def signalled(self, name: str, number: signal.Signals) -> None:
        """Send a signal to the running processes whose name begins with `name`."""
        for one, child in self.running.items():
            if one.startswith(name) and child.poll() is None:
                child.send_signal(number)

    def end(self) -> dict[str, int]:
        """Send SIGTERM to all, SIGKILL to those that do not end in time. Returns the exit codes."""
        for child in reversed(self.running.values()):
            if child.poll() is None:
                child.terminate()
        until_s = time.monotonic() + GRACE_S
        while any(child.poll() is None for child in self.running.values()):
            if is_due(until_s, time.monotonic()):
                break
            time.sleep(0.02)
        for child in self.running.values():
            if child.poll() is None:
                child.kill()
            child.wait()
        return {name: int(child.returncode) for name, child in self.running.items()}
