"""Machine code of drivers with loops: the driver and all it calls, as written, compiled by numba.

`core.compiled` turns one kernel into a map over arrays; a driver here is a plain function over
arrays with loops and early exits. Its text, the text of the kernels it calls and the values of
the constants it names are written into one module and compiled there, with the same flags and in
the same private cache. So the kernels inside of the loops are the proved ones, unchanged.
"""

from __future__ import annotations

import functools
import inspect
import textwrap
from collections.abc import Callable
from typing import Any, get_type_hints

from cratous.core.compiled import FLAGS, load

HEAD = """import math
from math import sqrt
from typing import NamedTuple

import numpy as np
from numba import njit
"""


def _record(cls: Any) -> str:
    """A NamedTuple of numbers, and a function of its name that gives every field its type."""
    fields = get_type_hints(cls)
    name = cls.__name__
    lines = [f"class {name}_(NamedTuple):"]
    lines += [f"    {field}: {kind.__name__}" for field, kind in fields.items()]
    casts = ", ".join(f"{kind.__name__}({field})" for field, kind in fields.items())
    lines += ["", "", f"@{FLAGS}", f"def {name}({', '.join(fields)}):"]
    return "\n".join([*lines, f"    return {name}_({casts})"])


def _collect(function: Any, found: dict[str, str], constants: dict[str, str]) -> None:
    """Sources of a function and of what it uses, callees first."""
    name = function.__name__
    if name in found:
        return
    if inspect.isclass(function):
        found[name] = _record(function)
        return
    for used in function.__code__.co_names:
        value = function.__globals__.get(used)
        if isinstance(value, bool | int | float):
            constants[used] = f"{used} = {value!r}"
        elif getattr(value, "__module__", "").startswith("cratous.") and (
            inspect.isfunction(value) or inspect.isclass(value)
        ):
            _collect(value, found, constants)
    lines = textwrap.dedent(inspect.getsource(function)).splitlines()
    while not lines[0].startswith("def "):
        lines.pop(0)
    found[name] = "\n".join([f"@{FLAGS}", *lines])


@functools.cache
def machine(driver: Callable[..., Any]) -> Callable[..., Any]:
    """The driver in machine code; arguments are numbers and arrays of float64, int64 or bool."""
    found: dict[str, str] = {}
    constants: dict[str, str] = {}
    _collect(driver, found, constants)
    text = "\n\n".join([HEAD, "\n".join(sorted(constants.values())), *found.values(), ""])
    made: Callable[..., Any] = getattr(load(text), driver.__name__)
    return made
