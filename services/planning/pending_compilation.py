"""Machine code being compiled by another process: users wait for it instead of compiling it again.

`services/startup/ahead.py` announces it; without an announcement nothing is waited for.
"""

from __future__ import annotations

from collections.abc import Callable

ROUTES, AROUND, ASSIGNMENT = "routes", "around", "assignment"
MANY_WAYS = 300
"""Above this many routes, it is estimated whether many lead around zones; they are searched in blocks of this
size.
"""
WORTH_WAITING = {ROUTES: 12_000, AROUND: 4_000}
"""Below this many routes, CPython is about as fast as waiting for the machine code."""
_coming: dict[str, Callable[[], None]] = {}


def expect(name: str, wait: Callable[[], None]) -> None:
    """Announce machine code of this name; `wait` returns when its compilation has ended, successfully or not."""
    _coming[name] = wait


def ready(name: str) -> None:
    """Wait for announced machine code of this name, if there is any."""
    wait = _coming.pop(name, None)
    if wait is not None:
        wait()
