"""SIGTERM and SIGHUP end a command as Ctrl-C does: what is half done is cleaned up on the way out."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

STOPS = (signal.SIGTERM, signal.SIGHUP)
_asked: list[int] = []
"""The signal that has asked the command of this process to end."""


class Stopped(SystemExit):
    """A signal asks to end; the exit code is 128 and its number."""

    def __init__(self, number: int) -> None:
        super().__init__(128 + number)
        self.exit_code = 128 + number
        self.name = signal.Signals(number).name


def stop_behind(error: BaseException | None) -> Stopped | None:
    """The signal to stop while which was handled an error came up, say of what was being closed; None if there is none.

    Python itself may raise one in its place, as where it comes between the two steps of a wait for an event.
    """
    while error is not None and not isinstance(error, Stopped):
        error = error.__context__
    return error


def heed() -> None:
    """Raise `Stopped` once more if a signal has asked to end and the command still works.

    Where libraries run that catch whatever comes up in them (dask, say), the first may have been lost.
    """
    if _asked:
        raise Stopped(_asked[0])


@contextmanager
def handlers_as_before() -> Iterator[None]:
    """What a command of this process does about Ctrl-C and the like ends with the command, for who has called it."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, *STOPS)}
    try:
        yield
    finally:
        for number, handler in before.items():
            if handler is not None:  # None: not made by Python, and not to be made again by it
                signal.signal(number, handler)


@contextmanager
def stoppable() -> Iterator[None]:
    """In here these signals raise `Stopped`; those that the caller ignores (nohup) stay ignored."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    process = os.getpid()

    def stop(number: int, _frame: Any) -> None:
        if os.getpid() != process:  # a process forked from here has nothing of ours to clean up
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
            return
        for other in STOPS:  # once is enough: nothing disturbs the cleaning
            signal.signal(other, signal.SIG_IGN)
        _asked.append(number)
        raise Stopped(number)

    before = {n: signal.getsignal(n) for n in STOPS}
    ours = [n for n in STOPS if before[n] is signal.SIG_DFL]
    if ours:  # else within another such block
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
