"""Copies of functions, with all that they call, that use another square root.

On rationals `math.sqrt` would return a double, so that results would no longer be exact.
"""

from __future__ import annotations

import functools
import inspect
import math
import types
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from cratous.core.kernel.sources import is_root

Root = Callable[[Any], Any]


class Undecided(Exception):
    """These numbers are inconclusive: a result is irrational, or arbitrary."""


def rational_root(value: Any) -> Any:
    """The square root of a rational if it is rational; Undecided otherwise.

    Raises ValueError below 0, as `math.sqrt` does.
    """
    number = Fraction(value)
    if number < 0:
        raise ValueError("math domain error")
    top, bottom = math.isqrt(number.numerator), math.isqrt(number.denominator)
    if top * top != number.numerator or bottom * bottom != number.denominator:
        raise Undecided("a square root that is no rational number")
    return Fraction(top, bottom)


class _Later:
    """Calls the copy of a function, which is made at the first call."""

    def __init__(self, function: types.FunctionType, root: Root) -> None:
        self.function, self.root = function, root

    def __call__(self, *args: Any, **named: Any) -> Any:
        return with_root(self.function, self.root)(*args, **named)


@functools.cache
def with_root(function: Callable[..., Any], root: Root) -> Callable[..., Any]:
    """The function with another square root, also in everything that it calls by a name of its module."""
    if not isinstance(function, types.FunctionType):
        return function
    scope = dict(function.__globals__)
    for name in function.__code__.co_names:
        value = scope.get(name)
        if is_root(value):
            scope[name] = root
        elif inspect.isfunction(value):
            scope[name] = _Later(value, root)
    made = types.FunctionType(
        function.__code__, scope, function.__name__, function.__defaults__, function.__closure__
    )
    made.__kwdefaults__ = function.__kwdefaults__
    return made
