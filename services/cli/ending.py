"""Ends the process of a command without taking the interpreter apart, which would take it tens of milliseconds."""

from __future__ import annotations

import atexit
import os
import sys
import threading


def end(code: int) -> None:
    """End this process with an exit code, as the interpreter would, except for the objects that are still there.

    Threads that are not daemons are waited for, exit handlers run (temporary folders, children), and the standard
    streams are flushed. Raises SystemExit instead if a stream cannot be flushed, which the interpreter reports, and under a
    profiler or tracer, which writes its findings afterwards.
    """
    if sys.getprofile() is not None or sys.gettrace() is not None:
        raise SystemExit(code)
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    try:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
    except (OSError, ValueError):
        raise SystemExit(code) from None
    os._exit(code)
