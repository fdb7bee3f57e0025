"""Names in running functions that mean something else than the files of their modules say.

A function's own code may be its file's while its module was given another helper under the same name, which
then runs in the helper's place. Held against the file are functions, classes and what is imported from a
module; values are part of the keys (`core/kernel/sources.constants`).
"""

from __future__ import annotations

import functools
import inspect
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FunctionType
from typing import Any, NamedTuple

from cratous.core.kernel import Fold
from cratous.core.kernel.sources import names_of, ours, reached, runs_as_written
from cratous.core.ledger.tables import table


class _Meant(NamedTuple):
    """What a file says of a name. module, name: where it is defined, or imported from."""

    kind: str
    module: str
    name: str


@functools.cache
def _file_says(module: str) -> dict[str, _Meant]:
    """Every name that a module's file binds once, to a function, a class, or something of another module."""
    file = Path(str(sys.modules[module].__file__))
    read = table(file.read_bytes(), module, file.name == "__init__.py")
    found = {}
    for name, numbers in read.bound.items():
        units = [read.units[number] for number in numbers]
        if len(units) != 1:
            continue
        (unit,) = units
        if unit.kind in ("function", "class"):
            found[name] = _Meant(unit.kind, module, name)
        elif unit.kind == "import" and unit.imports[0][2]:
            found[name] = _Meant("import", unit.imports[0][1], unit.imports[0][2])
    return found


Looked = dict[FunctionType, tuple[str, ...]]
"""What was found of functions so far: many rest on the same ones."""


def replaced(item: Callable[..., Any] | Fold[Any], looked: Looked) -> list[str]:
    """Names that are not what their files say, of `item` and all that it rests on."""
    found: set[str] = set()
    for value in reached(item).values():
        if inspect.isfunction(value):
            if value not in looked:
                looked[value] = tuple(_of(value))
            found.update(looked[value])
    return sorted(found)


def _of(function: FunctionType) -> Iterator[str]:
    says, scope = _file_says(function.__module__), function.__globals__
    for used in names_of(function.__code__):
        if used in says and used in scope and not _is(scope[used], says[used]):
            yield f"{function.__module__}.{used}"


def _is(value: Any, meant: _Meant) -> bool:
    if meant.kind == "import":
        source = sys.modules.get(meant.module)
        if source is None or meant.name not in vars(source):
            return True  # a module of its own, or what its package gives out when it is asked
        return bool(vars(source)[meant.name] is value)
    named = (getattr(value, "__module__", None), getattr(value, "__qualname__", None))
    # a decorator's own object has the name of what it marks, or is none that has a name
    if not inspect.isfunction(value) and not inspect.isclass(value) and named == (None, None):
        return True
    if isinstance(value, Fold):
        return True
    return named == (meant.module, meant.name) and (
        not inspect.isfunction(value) or not ours(value) or runs_as_written(value)
    )
