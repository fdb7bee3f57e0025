"""Writes a results folder in a process of its own that is killed at a chosen step; run by
test_results.py: `python results_child.py TARGET STEP HOW`.

STEP is the number of the system call of the writer (renames, links, removals, writes to disk) before
which the process kills itself, HOW is `exchange` or `renames`. Prints how many steps it made if it
came to its end.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cratous.services.results import swap
from cratous.services.results.folder import results_folder

CALLS = ("rename", "link", "unlink", "rmdir", "mkdir", "fsync", "open", "replace")
count = 0


def counted(call: Callable[..., Any], stop: int) -> Callable[..., Any]:
    def step(*arguments: Any, **named: Any) -> Any:
        global count
        if count == stop:
            os.kill(os.getpid(), signal.SIGKILL)
        count += 1
        return call(*arguments, **named)

    return step


def main() -> None:
    target, stop, how = Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    if how == "renames":
        swap.exchange = lambda _one, _other: False
    elif how == "wait":
        with results_folder(target) as folder:
            (folder / "report.json").write_text("never")
            print("ready", flush=True)
            time.sleep(60)
    else:
        swap.exchange = counted(swap.exchange, stop)
    for name in CALLS:
        setattr(os, name, counted(getattr(os, name), stop))
    with results_folder(target) as folder:
        for name in ("report.json", "log.sqlite"):
            (folder / name).write_text("new")
    print(count)


main()
