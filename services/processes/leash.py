"""A process that another one has started for itself ends with that one, even if that is killed."""

from __future__ import annotations

import ctypes
import os
import signal
import sys

ENDS_WITH = "CRATOUS_ENDS_WITH"
"""The variable of the environment that names the pid of the parent whose end is this process's too."""
AT_ONCE = " KILL"
"""What stands behind that pid for a process that may be stopped then: SIGTERM would wait until it goes on."""
_PR_SET_PDEATHSIG = 1


def end_with_parent() -> None:
    """If `ENDS_WITH` asks for it, have Linux send SIGTERM, or SIGKILL, when the parent ends; SystemExit if it has already."""
    asked = os.environ.pop(ENDS_WITH, "")  # it is of this process alone
    parent = asked.removesuffix(AT_ONCE)
    if not parent or sys.platform != "linux":
        return
    number = signal.SIGTERM if asked == parent else signal.SIGKILL
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(number), 0, 0, 0)
    if str(os.getppid()) != parent:
        raise SystemExit(128 + signal.SIGTERM)
