"""Limits the CPU time of a block of code.

Stating a theorem asks the solver which paths are feasible. Those questions are budgeted by effort, but there is work
that z3 does not count, and a statement may also loop by itself. A block over its limit is interrupted in the solver
and in Python; only CPU time counts, not the load of the machine. Code that does not react to the interrupt is ended
by the system together with its process, provided that another process waits for that one (`may_be_killed`).
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
"""Wall seconds between two readings of the CPU clock."""


GRACE_S = 10.0
"""CPU seconds allowed for reacting to an interrupt."""
_MAY_BE_KILLED: set[int] = set()


class OutOfTime(BaseException):
    """The CPU time is used up; not an `Exception`, so that no handler in the block catches it by accident."""


def of_the_user() -> float:
    """The CPU time limit [s] set for this process from outside (`ulimit -t`); infinity if there is none."""
    bounds = [b for b in resource.getrlimit(resource.RLIMIT_CPU) if b != resource.RLIM_INFINITY]
    return min(bounds, default=math.inf)


def what_ended(code: int | None, seconds: float = math.inf) -> str:
    """Which limit ended a process forked from this one, in words; code: its exit code.

    seconds: the limit [s] of `ends_within` in that process.
    """
    user = of_the_user()
    killed = code in (-signal.SIGXCPU, -signal.SIGKILL)
    if killed and user < math.inf and user < seconds + GRACE_S + 1:
        return (
            f"ended by the limit of CPU time that cratous was started with (ulimit -t {user:.0f})"
        )
    if code == -signal.SIGXCPU:
        spent = "" if seconds == math.inf else f" of {seconds + GRACE_S:.0f} s"
        return f"ended by the prover's own limit of CPU time{spent}: it heeded no interrupt"
    return f"its process ended before it answered (exit code {code})"


def _throw(thread: int, error: type[BaseException] | None) -> None:
    """Raise the error in a thread as soon as it runs Python; None clears a pending error."""
    pending = None if error is None else ctypes.py_object(error)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), pending)


def may_be_killed() -> None:
    """From now on `ends_within` may end this process: its parent waits for it and handles its end."""
    _MAY_BE_KILLED.add(os.getpid())
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


@contextmanager
def ends_within(seconds: float) -> Iterator[None]:
    """The system ends this process (SIGXCPU) once the block has used `seconds` + GRACE_S CPU seconds.

    Does nothing in a process for which `may_be_killed` was not called.
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
    """Raises OutOfTime in the block once the process has used `seconds` CPU seconds [s] in it.

    context: the z3 context of the block's questions; a running query in it is interrupted.
    """
    latest = time.process_time() + seconds
    over, done = threading.Event(), threading.Event()
    thread = threading.get_ident()

    def watch() -> None:
        # repeated until it takes effect: an error raised inside a callback is lost
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
            # if the error is raised here, the watcher has not stopped yet
            done.set()
    except Exception as error:
        if over.is_set():
            # the solver reports the interrupt as an error of its own
            raise OutOfTime from error
        raise
    finally:
        done.set()
        watcher.join()
        _throw(thread, None)
