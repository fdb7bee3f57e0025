"""Machine-code versions of the search loops (`core.readings.machine.compiled.machine`), for instances large enough to
justify compilation, and where there is machine code already.

CPython runs the same functions, with the same results.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np

from cratous.core.readings.machine.compiled import machine
from cratous.core.readings.tiered import swift

SMALL_TASKS, SMALL_MOVES = 3, 120
"""Largest number of tasks, and of vehicles times options, of a small instance."""
MODERATE_TASKS, MODERATE_MOVES = 6, 180
"""The same of a moderate instance: CPython mostly solves it within a second, and compiling takes many."""

STEPS = 300
"""Elementary steps of a loop that CPython does in about a tenth of a millisecond, the unit of `swift`."""


def machine_for(instance: Any, function: Callable[..., Any], steps: int = 0) -> Callable[..., Any]:
    """The function compiled, or for a small or moderate instance what `swift` chooses for so many steps; all give the
    same results.
    """
    if steps and is_moderate(instance):
        return _wrapping(swift(function, 1 + steps // STEPS))
    return _plainly(function) if is_small(instance) else machine(function)


def machine_searching(
    instance: Any, function: Callable[..., Any], steps: int
) -> Callable[..., Any]:
    """`machine_for` of a search of about so many steps, which for a small instance CPython does."""
    return _plainly(function) if is_small(instance) else machine_for(instance, function, steps)


def is_small(instance: Any) -> bool:
    """Whether an instance is small enough to be searched by CPython without compilation."""
    return bool(instance.tasks <= SMALL_TASKS and instance.may.size <= SMALL_MOVES)


def is_moderate(instance: Any) -> bool:
    """Whether CPython begins to solve an instance, and goes on unless there is machine code already or much to do."""
    few = instance.tasks <= MODERATE_TASKS and instance.may.size <= MODERATE_MOVES
    return bool(few or is_small(instance))


CHILD = 100
"""Steps per child of a state in a search."""
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


def machine_after(
    little: bool, instance: Any, function: Callable[..., Any], steps: int
) -> Callable[..., Any]:
    """`machine_searching`: CPython while few nodes are visited, or if the whole search is small."""
    return _plainly(function) if little else machine_searching(instance, function, steps)


def _wrapping(function: Callable[..., Any]) -> Callable[..., Any]:
    def run(*given: Any) -> Any:
        # numpy integers wrap around in hashes and random numbers, as compiled ones do
        with np.errstate(over="ignore"):
            return function(*given)

    return run


@functools.cache
def _plainly(function: Callable[..., Any]) -> Callable[..., Any]:
    return functools.wraps(function)(_wrapping(function))
