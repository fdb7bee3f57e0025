"""Loops over arrays, in CPython until there is much to do, then in machine code: the same results.

`core.readings.machine.compiled.machine` compiles the text that CPython runs, so which of the two ran cannot be seen
in what comes out (`tests/routing/test_routing.py`); only the time differs. Short jobs start without the
compiler. Compiling takes seconds, so machine code that an earlier run has kept is used much sooner;
not while calls are counted, as which reading ran is then told (`by_work_alone`).
"""

import contextlib
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

from cratous.core.kernel import qualified

SOON, MUCH, WORTH = 300, 3_000, 60_000
"""After so much work the compiled loop is used: if it is kept, if work alone counts, if it is not kept."""
DEAR = {"cratous.core.daa.guidance.guide": 4, "cratous.core.routing.bulk.direct_many": 4}
"""Loops that take long to compile wait for so many times as much where work alone counts: CPython has done it sooner."""
_patience: list[int | None] = [None]
_done: Counter[str] = Counter()
_compiled: dict[str, Callable[..., Any]] = {}
_coming: dict[str, Callable[[], None]] = {}


def expect(function: Callable[..., Any], wait: Callable[[], None]) -> None:
    """Another process makes this function's machine code; `wait` returns when that has ended, well or not.

    When work reaches the limit that is waited for, and nothing else depends on it.
    """
    _coming[qualified(function)] = wait


def swift(function: Callable[..., Any], work: int = 1) -> Callable[..., Any]:
    """The function as it stands, or compiled once enough has been done with it.

    work: how much this call does; a unit is about what CPython does in a tenth of a millisecond.
    """
    name = qualified(function)
    known = _compiled.get(name)
    if known is not None:
        return known
    _done[name] += work
    if _done[name] <= _limit(function, _done[name]):
        return function
    wait = _coming.pop(name, None)
    if wait is not None:
        wait()
    from cratous.core.readings.machine.compiled import machine

    _compiled[name] = machine(function)
    return _compiled[name]


def _limit(function: Callable[..., Any], done: int) -> int:
    """How much is done with a function before it is compiled."""
    fixed = _patience[-1]
    if fixed is not None:
        return fixed * DEAR.get(qualified(function), 1)
    if done <= SOON:
        return SOON
    from cratous.core.readings.machine.compiled import is_kept

    return SOON if is_kept(function) else WORTH


def _begin_anew() -> None:
    _done.clear()
    _compiled.clear()


@contextlib.contextmanager
def by_work_alone() -> Iterator[None]:
    """Inside, when the compiler takes over follows from the work done inside, and from nothing else."""
    _begin_anew()
    _patience.append(MUCH)
    try:
        yield
    finally:
        _patience.pop()
        _begin_anew()


@contextlib.contextmanager
def at_once() -> Iterator[None]:
    """Inside, everything is compiled at its first call: for a cache that is to be complete."""
    _patience.append(-1)
    try:
        yield
    finally:
        _patience.pop()
