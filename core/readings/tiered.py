"""Loops over arrays, in CPython until there is much to do, then in machine code: the same results.

`core.readings.machine.compiled.machine` compiles the text that CPython runs, so which of the two ran cannot be seen
in what comes out (`tests/routing/test_routing.py`); only the time differs. Short jobs start without the
compiler.
"""

import contextlib
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

from cratous.core.kernel import qualified

MUCH = 300
_patience = [MUCH]
_done: Counter[str] = Counter()
_compiled: dict[str, Callable[..., Any]] = {}


def swift(function: Callable[..., Any], work: int = 1) -> Callable[..., Any]:
    """The function as it stands, or compiled once more than MUCH has been done with it.

    work: how much this call does; a unit is about what CPython does in a tenth of a millisecond.
    """
    name = qualified(function)
    known = _compiled.get(name)
    if known is not None:
        return known
    _done[name] += work
    if _done[name] <= _patience[-1]:
        return function
    from cratous.core.readings.machine.compiled import machine

    _compiled[name] = machine(function)
    return _compiled[name]


def begin_anew() -> None:
    """Forget what has been done: when the compiler takes over depends on what comes now alone."""
    _done.clear()
    _compiled.clear()


@contextlib.contextmanager
def at_once() -> Iterator[None]:
    """Inside, everything is compiled at its first call: for a cache that is to be complete."""
    _patience.append(-1)
    try:
        yield
    finally:
        _patience.pop()
