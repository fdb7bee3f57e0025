"""Reads the values of a case: typed and finite; other values are refused by name."""

from __future__ import annotations

import math
from typing import Any

from cratous.spec.errors import BadInput


def number(case: dict[str, Any], name: str) -> float:
    """A finite number of a vector; BadInput for anything else."""
    return finite(_there(case, name), name)


def not_negative(case: dict[str, Any], name: str) -> float:
    """A finite number of at least zero, for example a threshold."""
    value = number(case, name)
    if value < 0:
        raise BadInput("a threshold below zero", item=name, expected="0 or more", got=str(value))
    return value


def vector(case: dict[str, Any], name: str, size: int) -> tuple[float, ...]:
    """A list of the given number of finite numbers."""
    return numbers(_there(case, name), name, size)


def numbers(value: Any, name: str, size: int) -> tuple[float, ...]:
    """The same, for a value that was read already."""
    if not isinstance(value, list) or len(value) != size:
        raise BadInput("not a vector", item=name, expected=f"{size} numbers", got=repr(value)[:60])
    return tuple(finite(part, name) for part in value)


def truth(case: dict[str, Any], name: str) -> bool:
    """A truth value of a vector; BadInput for anything else."""
    value = _there(case, name)
    if not isinstance(value, bool):
        raise BadInput("not a truth value", item=name, expected="true or false", got=repr(value))
    return value


def finite(value: Any, name: str) -> float:
    """A finite number as a double; an integer only if it is exact."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise BadInput("not a number", item=name, expected="a number", got=repr(value)[:60])
    if not math.isfinite(value):
        raise BadInput("not finite", item=name, expected="a finite number", got=str(value))
    if isinstance(value, int) and int(float(value)) != value:
        raise BadInput("no double holds this integer", item=name, got=str(value)[:60])
    return float(value)


def _there(case: dict[str, Any], name: str) -> Any:
    if name not in case:
        raise BadInput("a value is missing", item=name, expected=f"the field {name!r}")
    return case[name]


def identity(case: dict[str, Any]) -> str:
    """The case's id for messages."""
    return str(case.get("id", "a case without id"))
