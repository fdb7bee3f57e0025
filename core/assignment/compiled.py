"""Machine-code versions of the search loops (`core.readings.machine.compiled.machine`), for instances large enough to
justify compilation.

CPython runs the same functions, with the same results. It runs small instances too, until it has spent more time in
a function than loading its machine code takes; code that counts calls gets one entry for either (`entered_by`).
"""

from __future__ import annotations

import contextlib
import functools
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from cratous.core.readings.machine.compiled import is_kept, machine

SMALL_TASKS, SMALL_MOVES = 3, 120
"""Largest number of tasks, and of vehicles times options, of a small instance."""


def machine_for(instance: Any, function: Callable[..., Any]) -> Callable[..., Any]:
    """The function run by CPython for a small instance, else compiled; both give the same results."""
    return _plainly(function) if is_small(instance) else machine(function)


def is_small(instance: Any) -> bool:
    """Whether an instance is small enough to be searched by CPython without compilation."""
    return bool(instance.tasks <= SMALL_TASKS and instance.may.size <= SMALL_MOVES)


PASS_MOST = 10_000
"""Tasks times vehicles times options that CPython passes over in some 10 ms."""
FIRST_NODES, STATES_MOST, DEALING_MOST = 500, 128, 2_000
"""Limits up to which CPython is used at first: nodes of a search, states of a list, steps of the longest question to
`deals`.
"""


def machine_for_pass(instance: Any, function: Callable[..., Any]) -> Callable[..., Any]:
    """`machine_for` of a function that makes one pass over all tasks and moves: compiled only if
    there are very many.
    """
    if instance.tasks * instance.may.size > PASS_MOST:
        return machine_for(instance, function)
    return _plainly(function)


def is_brief(instance: Any) -> bool:
    """Whether tasks can be distributed in few ways, so that no question to `deals` takes long."""
    ways = instance.tasks * len(instance.may)
    for j in range(instance.tasks):
        ways *= int(instance.may[:, instance.task == j].any(axis=1).sum())
        if ways > DEALING_MOST:
            return False
    return True


def machine_after(little: bool, instance: Any, function: Callable[..., Any]) -> Callable[..., Any]:
    """`machine_for` of a search: CPython while few nodes are visited, or if the whole search is small."""
    return _plainly(function) if little else machine_for(instance, function)


def _plainly(function: Callable[..., Any]) -> Callable[..., Any]:
    run, enter = _sooner(function), _entered[-1]
    if enter is not None:
        run = enter(function, run)
    return functools.partial(_timed, function, run)


LOADED_S, SOON_S = 0.5, 0.05
"""Time in CPython after which a function's machine code is used, if it is kept: what loading the compiler takes, and
what loading the function takes where the compiler is loaded."""
_took_s: defaultdict[Callable[..., Any], float] = defaultdict(float)
_asked_s: dict[Callable[..., Any], float] = {}


def _sooner(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function, or its kept machine code once CPython has spent much time in it."""
    took_s = _took_s[function]
    if took_s < (SOON_S if "numba" in sys.modules else LOADED_S) or took_s < _asked_s.get(
        function, 0.0
    ):
        return function
    if is_kept(function):
        return machine(function)
    _asked_s[function] = 2 * took_s  # a parallel process may compile it
    return function


def _timed(function: Callable[..., Any], run: Callable[..., Any], *given: Any) -> Any:
    """The result of a call, with the time that it took added to that of the function."""
    begun_s = time.thread_time()
    # numpy integers wrap around in hashes and random numbers, as compiled ones do
    with np.errstate(over="ignore"):
        found = run(*given)
    _took_s[function] += time.thread_time() - begun_s
    return found


Loop = Callable[..., Any]
_entered: list[Callable[[Loop, Loop], Loop] | None] = [None]


@contextlib.contextmanager
def entered_by(enter: Callable[[Loop, Loop], Loop]) -> Iterator[None]:
    """Context in which a function that CPython runs is what `enter` makes of it, as in `core.readings.tiered`: one
    entry for the loop, with what it calls as its parts.
    """
    _entered.append(enter)
    try:
        yield
    finally:
        _entered.pop()
