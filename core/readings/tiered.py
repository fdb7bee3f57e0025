"""Loops over arrays, in CPython until there is much to do, then in machine code: the same results.

`core.readings.machine.compiled.machine` compiles the text that CPython runs, so the results do not show which of the
two ran (`tests/routing/test_routing.py`); only the time differs. Short jobs start without the compiler. Compiling
takes seconds, so machine code that is cached, by an earlier run or by a parallel process, is used much sooner. Code
that counts calls gets each loop together with what runs it (`entered_by`), so that counts are the same for both.

A loop that CPython runs may have the loops that it calls run as machine code (`within`).
"""

import contextlib
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

from cratous.core.kernel import qualified

Loop = Callable[..., Any]
SOON, LOADED, WORTH = 300, 5_000, 60_000
"""Amount of work after which the compiled loop is used: if it is cached and another one is in use already, if it is
cached (loading the compiler takes half a second, which pays once all loops together have done so much), and if it is
not."""
_at_once: list[bool] = [False]
_entered: list[Callable[[Loop, Loop], Loop] | None] = [None]
_done: Counter[str] = Counter()
_compiled: dict[str, Loop] = {}
_inner: dict[str, Loop] = {}
"""Machine code by itself, without the entry that is counted."""
_coming: dict[str, Callable[[], None]] = {}


def expect(function: Loop, wait: Callable[[], None]) -> None:
    """Announce that another process compiles this function; `wait` returns when that has ended, successfully or not.

    It is called when the work reaches the limit; nothing else depends on it.
    """
    _coming[qualified(function)] = wait


def swift(function: Loop, work: int = 1) -> Loop:
    """The function as written, or compiled once enough work has been done with it.

    work: the work of this call; a unit is about what CPython does in a tenth of a millisecond.
    """
    run, enter = _chosen(function, work), _entered[-1]
    return run if enter is None else enter(function, run)


def within(function: Loop, work: int = 1) -> Loop:
    """`swift` of a function that is called in a loop: part of that loop, so no entry of its own.

    To the compiler `within(f, n)(...)` is `f(...)`.
    """
    name = qualified(function)
    if name not in _inner:
        made: Any = _chosen(function, work)
        if made is not function:
            _inner[name] = made.run
    return _inner.get(name, function)


def _chosen(function: Loop, work: int) -> Loop:
    name = qualified(function)
    known = _compiled.get(name)
    if known is not None:
        return known
    before = _done[name]
    _done[name] = before + work
    if not _is_time(function, before, before + work):
        return function
    wait = _coming.pop(name, None)
    if wait is not None and not _is_kept(function):
        wait()
    from cratous.core.readings.machine.compiled import machine

    _compiled[name] = machine(function)
    return _compiled[name]


def _is_time(function: Loop, before: int, done: int) -> bool:
    """Whether a function is to be compiled now, given the work done before and including this call."""
    if _at_once[-1] or done > WORTH:
        return True
    # checked periodically: a parallel process may have compiled it since
    if (done - 1) // SOON == max(before - 1, 0) // SOON:
        return False
    return (bool(_compiled) or _done.total() > LOADED) and _is_kept(function)


def _is_kept(function: Loop) -> bool:
    from cratous.core.readings.machine.compiled import is_kept

    return is_kept(function)


@contextlib.contextmanager
def entered_by(enter: Callable[[Loop, Loop], Loop]) -> Iterator[None]:
    """Context in which `swift` returns what `enter` makes of a function and of what runs it."""
    _entered.append(enter)
    try:
        yield
    finally:
        _entered.pop()


@contextlib.contextmanager
def at_once() -> Iterator[None]:
    """Context in which everything is compiled at its first call: to fill a cache completely."""
    _at_once.append(True)
    try:
        yield
    finally:
        _at_once.pop()
