"""Lets a process end with the parent that started it, even if the parent is killed."""

from __future__ import annotations

import ctypes
import os
import signal
import sys

ENDS_WITH = "CRATOUS_ENDS_WITH"
"""Environment variable with the pid of the parent with which this process ends."""
AT_ONCE = " KILL"
"""Suffix of that pid for a process that may be stopped: SIGTERM would be pending until it continues."""
_PR_SET_PDEATHSIG = 1


def end_with_parent() -> None:
    """If `ENDS_WITH` is set, have Linux send SIGTERM or SIGKILL when the parent ends; SystemExit if it has
    ended already.
    """
    asked = os.environ.pop(ENDS_WITH, "")  # for this process only
    parent = asked.removesuffix(AT_ONCE)
    if not parent or sys.platform != "linux":
        return
    _end_with(parent, signal.SIGTERM if asked == parent else signal.SIGKILL)


def end_at_once_with(parent: int) -> None:
    """In a fork: have Linux send SIGKILL when the parent (its pid) ends; SystemExit if it has ended already."""
    _end_with(str(parent), signal.SIGKILL)


def _end_with(parent: str, number: signal.Signals) -> None:
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(number), 0, 0, 0)
    if str(os.getppid()) != parent:
        raise SystemExit(128 + signal.SIGTERM)
