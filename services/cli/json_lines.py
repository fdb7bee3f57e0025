"""What a process of `cratous serve` shares with the others: JSON on stdin and stdout, one object a line.

When stdin ends, whoever started the process is gone, and it ends too.
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
    """What writes a line to stdout, from any thread; all else that is printed goes to stderr from now on.

    Ctrl-C is for who started this process, and is ignored.
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
    """What whoever started this asks for, or its end: the main thread is interrupted, also where it waits or
    searches."""
    signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGTERM)
