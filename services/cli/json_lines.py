"""Common part of the processes of `cratous serve`: JSON on stdin and stdout, one object per line.

When stdin ends, the parent process is gone, and the process ends too.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable
from typing import Any

from cratous.spec.files.printable import json_text

Tell = Callable[[dict[str, Any]], None]


def told_on_stdout() -> Tell:
    """A thread-safe function that writes a line to stdout; all other output goes to stderr from now
    on.

    Ctrl-C is meant for the parent process, and is ignored.
    """
    out, writing = os.dup(1), threading.Lock()
    os.dup2(2, 1)
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def tell(what: dict[str, Any]) -> None:
        data = json_text(what).encode() + b"\n"
        with writing:
            while data:
                data = data[os.write(out, data) :]

    return tell


def end_main_thread() -> None:
    """End by request of the parent process: interrupts the main thread, even while it waits or searches."""
    signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGTERM)
