"""The compiled reading of search loops: a function with all that it calls, as one module of numba.

The text is that of the functions themselves, kernels included, with only the decorators changed;
`core.compiled.load` keeps it in the private cache folder under the hash of the text. CPython runs
the same functions, and gives the same results.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from cratous.core.compiled import _collect, load


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
