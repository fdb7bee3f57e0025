"""Loops over arrays, in CPython until there is much to do, then in machine code: the same results.

`core.daa_machine.machine` compiles the text that CPython runs, so which of the two ran cannot be seen
in what comes out (`tests/test_routing.py`); only the time differs. Short jobs start without the
compiler.
"""

from collections import Counter
from collections.abc import Callable
from typing import Any

MUCH = 300
_done: Counter[str] = Counter()
_compiled: dict[str, Callable[..., Any]] = {}


def swift(function: Callable[..., Any], work: int = 1) -> Callable[..., Any]:
    """The function as it stands, or compiled once more than MUCH has been done with it.

    work: how much this call does; a unit is about what CPython does in a tenth of a millisecond.
    """
    name = f"{function.__module__}.{function.__name__}"
    known = _compiled.get(name)
    if known is not None:
        return known
    _done[name] += work
    if _done[name] <= MUCH:
        return function
    from cratous.core.daa_machine import machine

    _compiled[name] = machine(function)
    return _compiled[name]
