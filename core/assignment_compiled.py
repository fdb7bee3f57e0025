"""The compiled reading of search loops: a function with all that it calls, as one module of numba.

The text is that of the functions themselves, kernels included, with only the decorators changed;
`core.compiled.load` keeps it in the private cache folder under the hash of the text. CPython runs
the same functions, and gives the same results: small instances are not worth compiling for.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np

from cratous.core.compiled import _collect, load

SMALL_TASKS, SMALL_MOVES = 3, 24
"""Up to so many tasks, and vehicles times options, an instance is small."""


@functools.cache
def machine(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function compiled. It may use numpy, kernels, and functions of `core` like itself."""
    found: dict[str, str] = {}
    _collect(function, found)
    head = "from math import sqrt\nfrom typing import Any, NamedTuple\n\nimport numpy as np\nfrom numba import njit\n"
    compiled: Callable[..., Any] = getattr(
        load("\n\n".join([head, *found.values()])), function.__name__
    )
    return compiled


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
