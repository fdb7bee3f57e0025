"""Definitions as closed objects with a name, for reading a statement without looking into them.

A claim gives each use of one a value (`closed_value`); see `proofs.statements.relations`.
"""

from __future__ import annotations

import types
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from cratous.core.kernel import Fold
from cratous.core.kernel.sources import ours

Function = Callable[..., Any]


def full_name(function: Any) -> str:
    """`package.folder.module.name` of a function or fold."""
    home = function.step if isinstance(function, Fold) else function
    return f"{home.__module__}.{function.__name__}"


def in_spec(function: Any) -> bool:
    """True iff it is a definition: a function of the product's `spec`, or of a package's."""
    return ours(function) and part_of(function) == "spec"


def part_of(function: Any) -> str:
    return str((*function.__module__.split("."), "")[1])


@dataclass(frozen=True)
class Closed:
    """A definition as seen by the statement: called or passed on, it stays closed."""

    function: Function
    claim: Any = field(compare=False, repr=False)

    def __call__(self, *args: Any) -> Any:
        return self.claim.closed_value(self.function, args)


class ClosedModule:
    """A module of `spec` whose functions stay closed."""

    def __init__(self, module: types.ModuleType, claim: Any) -> None:
        self._module, self._claim = module, claim

    def __getattr__(self, name: str) -> Any:
        return closed(getattr(self._module, name), self._claim)


def plain(function: Any) -> Function:
    return function.function if isinstance(function, Closed) else function


def closed(value: Any, claim: Any) -> Any:
    if isinstance(value, types.FunctionType) and in_spec(value):
        return Closed(value, claim)
    if isinstance(value, types.ModuleType) and value.__name__.split(".")[1:2] == ["spec"]:
        return ClosedModule(value, claim)
    return value


def _speaks_of_spec(value: Any) -> bool:
    """Whether the value is a helper of theorems: a function of proofs that can reach definitions."""
    if not isinstance(value, types.FunctionType) or part_of(value) != "proofs":
        return False
    return any(closed(each, None) is not each for each in value.__globals__.values())


def reopened(statement: Function, claim: Any) -> Function:
    """The statement with its helpers, whose globals hold closed definitions."""
    scopes: dict[int, dict[str, Any]] = {}

    def copy(function: Function) -> Function:
        assert isinstance(function, types.FunctionType)
        key = id(function.__globals__)
        if key not in scopes:
            scope = scopes[key] = dict(function.__globals__)
            for name, value in function.__globals__.items():
                scope[name] = copy(value) if _speaks_of_spec(value) else closed(value, claim)
        made = types.FunctionType(
            function.__code__, scopes[key], function.__name__, function.__defaults__,
            function.__closure__,
        )  # fmt: skip
        made.__kwdefaults__ = function.__kwdefaults__
        made.__annotations__ = dict(function.__annotations__)
        made.__module__ = function.__module__
        return made

    return copy(statement)
