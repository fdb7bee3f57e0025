"""SIGTERM and SIGHUP end a command as Ctrl-C does, with cleanup."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

STOPS = (signal.SIGTERM, signal.SIGHUP)
_asked: list[int] = []
"""The signal that has requested the end of this process's command."""


class Stopped(SystemExit):
    """Raised when a signal requests the end; the exit code is 128 plus its number."""

    def __init__(self, number: int) -> None:
        super().__init__(128 + number)
        self.exit_code = 128 + number
        self.name = signal.Signals(number).name


def stop_behind(error: BaseException | None) -> Stopped | None:
    """The stop signal in whose handling an error was raised, for example while closing; None if
    there is none.

    Python may raise another exception in its place, for example between the two steps of waiting
    for an event.
    """
    while error is not None and not isinstance(error, Stopped):
        error = error.__context__
    return error


def heed() -> None:
    """Raise `Stopped` again if a signal has requested the end and the command still runs.

    Libraries that catch every exception (such as dask) may have swallowed the first.
    """
    if _asked:
        raise Stopped(_asked[0])


@contextmanager
def handlers_as_before() -> Iterator[None]:
    """Restore the caller's signal handlers at the end of a command run inside its process."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, *STOPS)}
    try:
        yield
    finally:
        for number, handler in before.items():
            if handler is not None:  # None: not installed by Python, so Python cannot restore it
                signal.signal(number, handler)


@contextmanager
def stoppable() -> Iterator[None]:
    """Inside the block these signals raise `Stopped`; those that the caller ignores (nohup) stay ignored."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    process = os.getpid()

    def stop(number: int, _frame: Any) -> None:
        if os.getpid() != process:  # a forked process has nothing of ours to clean up
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
            return
        for other in STOPS:  # once is enough: the cleanup is not interrupted
            signal.signal(other, signal.SIG_IGN)
        _asked.append(number)
        raise Stopped(number)

    before = {n: signal.getsignal(n) for n in STOPS}
    ours = [n for n in STOPS if before[n] is signal.SIG_DFL]
    if ours:  # otherwise inside another such block
        _asked.clear()
    for number in ours:
        signal.signal(number, stop)
    try:
        yield
    finally:
        if ours:
            _asked.clear()
        for number in ours:
            with suppress(ValueError):
                signal.signal(number, signal.SIG_DFL)
