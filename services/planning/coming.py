"""Machine code that another process is making: who needs it waits for that, and does not make it once more.

`services/startup/ahead.py` says what is coming; where nobody has said anything, nothing is waited for.
"""

from __future__ import annotations

from collections.abc import Callable

ROUTES, AROUND, ASSIGNMENT = "routes", "around", "assignment"
MANY_WAYS = 300
"""Of so many ways it is asked whether many lead around zones; they are searched in blocks of so many."""
WORTH_WAITING = {ROUTES: 12_000, AROUND: 4_000}
"""CPython searches fewer ways about as soon as the machine code for them is made."""
_coming: dict[str, Callable[[], None]] = {}


def expect(name: str, wait: Callable[[], None]) -> None:
    """Machine code of this name is being made; `wait` returns when that has ended, well or not."""
    _coming[name] = wait


def ready(name: str) -> None:
    """Wait for what is coming under this name, if anything is."""
    wait = _coming.pop(name, None)
    if wait is not None:
        wait()
