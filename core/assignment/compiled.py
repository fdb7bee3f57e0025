"""The search loops in machine code (`core.readings.machine.compiled.machine`), where an instance is worth compiling for.

CPython runs the same functions, and gives the same results.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np

from cratous.core.readings.machine.compiled import machine

SMALL_TASKS, SMALL_MOVES = 3, 120
"""Up to so many tasks, and vehicles times options, an instance is small."""


def machine_for(instance: Any, function: Callable[..., Any]) -> Callable[..., Any]:
    """The function as CPython runs it for a small instance, else compiled; both say the same."""
    return _plainly(function) if is_small(instance) else machine(function)


def is_small(instance: Any) -> bool:
    """Whether CPython goes over an instance, for which nothing is compiled."""
    return bool(instance.tasks <= SMALL_TASKS and instance.may.size <= SMALL_MOVES)


PASS_MOST = 10_000
"""Tasks times vehicles times options that CPython goes over once in some 10 ms."""
FIRST_NODES, STATES_MOST, DEALING_MOST = 500, 128, 2_000
"""Nodes of a search, and states of a list, that CPython visits at first; and steps of the longest question to `deals`."""


def machine_for_pass(instance: Any, function: Callable[..., Any]) -> Callable[..., Any]:
    """`machine_for` of a function that goes over all tasks and moves once: compiled where they are very many."""
    if instance.tasks * instance.may.size > PASS_MOST:
        return machine_for(instance, function)
    return _plainly(function)


def is_brief(instance: Any) -> bool:
    """Whether tasks can be dealt out in few ways, so that no question to `deals` takes long."""
    ways = instance.tasks * len(instance.may)
    for j in range(instance.tasks):
        ways *= int(instance.may[:, instance.task == j].any(axis=1).sum())
        if ways > DEALING_MOST:
            return False
    return True


def machine_after(little: bool, instance: Any, function: Callable[..., Any]) -> Callable[..., Any]:
    """`machine_for` of a search: CPython where little is visited yet, or all there is is little."""
    return _plainly(function) if little else machine_for(instance, function)


@functools.cache
def _plainly(function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def run(*given: Any) -> Any:
        # integers of numpy wrap round in hashes and random numbers, as compiled ones do
        with np.errstate(over="ignore"):
            return function(*given)

    return run
