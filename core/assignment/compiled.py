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
    if instance.tasks > SMALL_TASKS or instance.may.size > SMALL_MOVES:
        return machine(function)
    return _plainly(function)


@functools.cache
def _plainly(function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def run(*given: Any) -> Any:
        # integers of numpy wrap round in hashes and random numbers, as compiled ones do
        with np.errstate(over="ignore"):
            return function(*given)

    return run
