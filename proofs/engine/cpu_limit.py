"""A block of code that may use so much CPU time and no more.

Stating a theorem asks the solver which paths are feasible. Those questions are budgeted by effort,
but there is work that z3 does not count, and a statement may also loop by itself. What uses too
much is interrupted in the solver and in Python; only CPU time counts, not what else the machine
does. What heeds no interrupt is ended by the system together with its process, where another process
waits for that one (`may_be_killed`).
"""

from __future__ import annotations

import ctypes
import math
import os
import resource
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import z3

PERIOD_S = 0.25
"""Wall seconds between two looks at the CPU clock."""


GRACE_S = 10.0
"""CPU seconds in which an interrupt is to be heeded."""
_MAY_BE_KILLED: set[int] = set()


class OutOfTime(BaseException):
    """The CPU time is used up; not an `Exception`, so that nothing in the block keeps it."""


def of_the_user() -> float:
    """CPU seconds [s] that this process was given from outside (`ulimit -t`); infinity where nothing limits it."""
    bounds = [b for b in resource.getrlimit(resource.RLIMIT_CPU) if b != resource.RLIM_INFINITY]
    return min(bounds, default=math.inf)


def what_ended(code: int | None, seconds: float = math.inf) -> str:
    """Which limit ended a process that was forked from this one, in words; code: its exit code.

    seconds: CPU seconds [s] of `ends_within` there.
    """
    user = of_the_user()
    killed = code in (-signal.SIGXCPU, -signal.SIGKILL)
    if killed and user < math.inf and user <= math.ceil(seconds + GRACE_S):
        return (
            f"ended by the limit of CPU time that cratous was started with (ulimit -t {user:.0f})"
        )
    if code == -signal.SIGXCPU:
        spent = "" if seconds == math.inf else f" of {seconds + GRACE_S:.0f} s"
        return f"ended by the prover's own limit of CPU time{spent}: it heeded no interrupt"
    return f"its process ended before it answered (exit code {code})"


def _throw(thread: int, error: type[BaseException] | None) -> None:
    """Raise the error in a thread as soon as it runs Python; with None what is pending is gone."""
    pending = None if error is None else ctypes.py_object(error)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), pending)


def may_be_killed() -> None:
    """From now on `ends_within` ends this process: another one waits for it, and knows what its end means."""
    _MAY_BE_KILLED.add(os.getpid())
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


@contextmanager
def ends_within(seconds: float) -> Iterator[None]:
    """The system ends this process (SIGXCPU) if the block uses so many CPU seconds (s) and GRACE_S more.

    Nothing is done in a process that may not be killed.
    """
    if os.getpid() not in _MAY_BE_KILLED:
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_CPU)
    latest = math.ceil(time.process_time() + seconds + GRACE_S)
    for bound in (soft, hard):
        if bound != resource.RLIM_INFINITY and bound < latest:
            latest = bound
    resource.setrlimit(resource.RLIMIT_CPU, (latest, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_CPU, (soft, hard))


@contextmanager
def cpu_limit(seconds: float, context: z3.Context) -> Iterator[None]:
    """Raises OutOfTime in the block once the process has used so many CPU seconds (s) in it.

    context: the one whose questions the block asks; what is being solved in it is interrupted.
    """
    latest = time.process_time() + seconds
    over, done = threading.Event(), threading.Event()
    thread = threading.get_ident()

    def watch() -> None:
        # again until it has come through: an error raised inside a callback is lost
        while not done.wait(PERIOD_S):
            if time.process_time() > latest:
                over.set()
                context.interrupt()
                _throw(thread, OutOfTime)

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        try:
            with ends_within(seconds):
                yield
        finally:
            # if the error comes up here, the next look is yet to come
            done.set()
    except Exception as error:
        if over.is_set():
            # the solver says in its own words that it was interrupted
            raise OutOfTime from error
        raise
    finally:
        done.set()
        watcher.join()
        _throw(thread, None)
