"""Frozen records (dataclasses, named tuples, enums) to plain JSON data and back.

The type hints are the schema: no registration is needed, and data that a hint does not allow is
refused. Named tuples become objects with their field names, so that a log can be read without this
code.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
import types
from collections.abc import Iterator
from enum import Enum
from functools import cache
from typing import Any, TypeVar, Union, cast, get_args, get_origin, get_type_hints

from cratous.spec.errors import BadInput

T = TypeVar("T")
_WORDS = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}


def to_data(value: Any) -> Any:
    """The value as dictionaries, lists, strings, numbers, booleans and None."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: to_data(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return {name: to_data(getattr(value, name)) for name in value._fields}
    if isinstance(value, (tuple, list)):
        return [to_data(item) for item in value]
    if isinstance(value, dict):
        return {str(key): to_data(item) for key, item in value.items()}
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise TypeError(f"cannot write a {type(value).__name__} as plain data")


def from_data(cls: type[T], data: Any, item: str = "") -> T:
    """A record of type `cls` from the output of `to_data`; BadInput if it does not fit."""
    return cast(T, _read(cls, data, item or cls.__name__))


def canonical(data: Any) -> str:
    """The unique text of a value: sorted keys, no spaces, shortest floats; no NaN or infinity."""
    return json.dumps(
        data, sort_keys=True, separators=(",", ":"), allow_nan=False, ensure_ascii=False
    )


def fingerprint(data: Any) -> str:
    """SHA-256 of the canonical text, in hexadecimal."""
    return hashlib.sha256(canonical(data).encode()).hexdigest()


@cache
def _hints(cls: type) -> dict[str, Any]:
    return get_type_hints(cls)


def _read(hint: Any, data: Any, item: str) -> Any:
    if type(data) is hint and hint in _WORDS:
        return data
    origin = get_origin(hint)
    if hint is Any:
        return data
    if origin in (Union, types.UnionType):
        return _read_optional(hint, data, item)
    if origin is tuple:
        return _read_tuple(get_args(hint), data, item)
    if isinstance(hint, type) and issubclass(hint, Enum):
        try:
            return hint(data)
        except ValueError:
            choices = ", ".join(str(member.value) for member in hint)
            raise _misfit(item, f"one of {choices}", data) from None
    if dataclasses.is_dataclass(hint) or hasattr(hint, "_fields"):
        return _read_record(hint, data, item)
    if hint is float and type(data) is int:
        return float(data)
    raise _misfit(item, _WORDS.get(hint, str(hint)), data)


def _read_optional(hint: Any, data: Any, item: str) -> Any:
    options = get_args(hint)
    if data is None and type(None) in options:
        return None
    rest = [option for option in options if option is not type(None)]
    if len(rest) != 1:
        raise TypeError(f"{item}: unions other than with None are not supported")
    return _read(rest[0], data, item)


def _read_tuple(hints: tuple[Any, ...], data: Any, item: str) -> tuple[Any, ...]:
    if not isinstance(data, (list, tuple)):
        raise _misfit(item, "a list", data)
    if len(hints) == 2 and hints[1] is Ellipsis:
        return tuple(_read(hints[0], part, f"{item}[{k}]") for k, part in enumerate(data))
    if len(hints) != len(data):
        raise _misfit(item, f"a list of {len(hints)}", data)
    return tuple(
        _read(hint, part, f"{item}[{k}]")
        for k, (hint, part) in enumerate(zip(hints, data, strict=True))
    )


def _read_record(cls: Any, data: Any, item: str) -> Any:
    if not isinstance(data, dict):
        raise _misfit(item, f"an object with {', '.join(_names(cls))}", data)
    # a subclass record is recognised by its fields; one that adds none is read as its base class
    names = _names(cls)
    if not names or data.keys() != set(names):
        cls = next((c for c in _below(cls) if data.keys() == set(_names(c))), cls)
        names = _names(cls)
    hints = _hints(cls)
    for name in data:
        if name not in names:
            raise BadInput("unknown field", item=f"{item}.{name}", expected=", ".join(names))
    found = {
        name: _read(hints[name], data[name], f"{item}.{name}") for name in names if name in data
    }
    try:
        return cls(**found)
    except TypeError:
        missing = ", ".join(name for name in names if name not in found)
        raise BadInput(
            "does not fit", item=item, expected=", ".join(names), got=f"none for {missing}"
        ) from None


def _below(cls: Any) -> Iterator[Any]:
    """All direct and indirect subclasses of a record."""
    for one in cls.__subclasses__():
        yield one
        yield from _below(one)


@cache
def _names(cls: Any) -> tuple[str, ...]:
    if hasattr(cls, "_fields"):
        return tuple(cls._fields)
    return tuple(f.name for f in dataclasses.fields(cls)) if dataclasses.is_dataclass(cls) else ()


def _misfit(item: str, expected: str, got: Any) -> BadInput:
    return BadInput("does not fit", item=item, expected=expected, got=_as_json(got)[:80])


def _as_json(got: Any) -> str:
    """A value as written in JSON: `null`, not `None`."""
    try:
        return json.dumps(got, ensure_ascii=False)
    except (TypeError, ValueError):
        return repr(got)
