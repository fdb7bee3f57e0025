"""Methods and fields of classes that differ from the files of their classes.

A method is looked up through its class at run time, so a replacement assigned to the class runs in its place. What
dataclass and NamedTuple generate from a text is compared with what they generate anew for an equal class; other
library methods are identified by file and name.
"""

from __future__ import annotations

import abc
import collections
import dataclasses
import enum
import functools
import inspect
import sys
import typing
from collections.abc import Iterator
from types import CodeType, FunctionType, MemberDescriptorType, ModuleType
from typing import Any

from cratous.core.kernel.sources import ours, runs_as_written, written_names

MAKERS: tuple[ModuleType, ...] = (abc, collections, dataclasses, enum, functools, typing)
LIBRARY = frozenset(str(module.__file__) for module in MAKERS)
"""Files with the code of methods that Python's library adds to a class."""
OTHERWISE = {
    "__getstate__": "_dataclass_getstate",
    "__setstate__": "_dataclass_setstate",
    "_new_member_": "__new__",
}
"""Library functions whose own name differs from the name they have in a class."""
SETTINGS = ("init", "repr", "eq", "order", "unsafe_hash", "frozen")
GETTER: Any = type(vars(collections.namedtuple("_Pair", "first"))["first"])
"""The type of object that reads a field of a NamedTuple."""


def other_methods(item: type) -> Iterator[str]:
    """Methods and fields of a class and its bases that were replaced."""
    for one in item.__mro__:
        if ours(one):
            yield from _of(one)


def _of(one: type) -> Iterator[str]:
    has, head = vars(one), f"{one.__qualname__}."
    written = _written(one.__module__).get(one.__qualname__, ())
    for name in written:
        value = has.get(name)
        inner = inspect.isclass(value) and value.__qualname__ == head + name
        if not inner and not _functions(value):
            yield f"{one.__module__}.{head}{name}"
    for name, value in has.items():
        functions = _functions(value)
        if not all(
            _is_own(f, one, name) or (name not in written and _is_made(f, one, name))
            for f in functions
        ):
            yield f"{one.__module__}.{head}{name}"
    for name in sorted(_other_fields(one)):
        yield f"{one.__module__}.{head}{name}"


@functools.cache
def _written(module: str) -> dict[str, tuple[str, ...]]:
    """The methods that a file defines, by class."""
    found: dict[str, dict[str, None]] = {}
    for name in written_names(str(sys.modules[module].__file__)):
        owner, _, last = name.rpartition(".")
        if owner and last.isidentifier() and not owner.endswith(">"):
            found.setdefault(owner, {})[last] = None
    return {owner: tuple(names) for owner, names in found.items()}


def _functions(value: Any) -> list[Any]:
    """The functions that run for this class attribute; none for a plain value."""
    if isinstance(value, FunctionType):
        return [value]
    if isinstance(value, staticmethod | classmethod):
        return [value.__func__]
    if isinstance(value, property):
        return [part for part in (value.fget, value.fset, value.fdel) if part is not None]
    if isinstance(value, functools.cached_property):
        return [value.func]
    wrapped = None if isinstance(value, type) else getattr(value, "__wrapped__", None)
    return [] if wrapped is None else [wrapped]


def _is_own(function: Any, one: type, name: str) -> bool:
    if not isinstance(function, FunctionType):
        return False
    named = (function.__module__, function.__qualname__)
    return named == (one.__module__, f"{one.__qualname__}.{name}") and runs_as_written(function)


def _is_made(function: Any, one: type, name: str) -> bool:
    """Whether a method is what the library generates for such a class under this name."""
    if not isinstance(function, FunctionType):
        return False
    code = function.__code__
    if code.co_filename in LIBRARY and function.__name__ == OTHERWISE.get(name, name):
        return True
    twins = _functions(vars(_made_anew(one)).get(name))
    return any(_does(code) == _does(twin.__code__) for twin in twins)


def _does(code: CodeType) -> tuple[Any, ...]:
    return code.co_filename, code.co_code, code.co_consts, code.co_names, code.co_varnames


@functools.cache
def _made_anew(one: type) -> type:
    """An equal NamedTuple or dataclass, with freshly generated methods."""
    has = vars(one)
    if "_field_defaults" in has:
        return collections.namedtuple(one.__name__, has["_fields"])
    if "__dataclass_params__" not in has:
        return object
    settings = {name: getattr(has["__dataclass_params__"], name) for name in SETTINGS}
    own = {"__post_init__": print} if hasattr(one, "__post_init__") else {}
    fields = [(f.name, f.type, _like(f)) for f in dataclasses.fields(one)]
    return dataclasses.make_dataclass(one.__name__, fields, namespace=own, **settings)


def _like(field: Any) -> Any:
    found: Any = dataclasses.field(
        init=field.init, repr=field.repr, hash=field.hash, compare=field.compare
    )
    found.default, found.default_factory = field.default, field.default_factory
    return found


def _other_fields(one: type) -> set[str]:
    """Fields of a NamedTuple that read another index, and slots that belong to another class."""
    has = vars(one)
    slots = {
        name
        for name, value in has.items()
        if isinstance(value, MemberDescriptorType) and value.__name__ != name
    }
    if "_field_defaults" not in has:
        return slots
    return slots | {
        name
        for number, name in enumerate(has["_fields"])
        if type(has.get(name)) is not GETTER or has[name].__reduce__()[1][0] != number
    }
