"""Names in running functions that refer to something else than the files of their modules say.

A function's own code may match its file while its module was given another helper under the same name, which then
runs in its place; likewise a class may be given another method. Compared with the file are functions, classes with
their methods and fields, modules, imported names, and the names of builtins; values are part of the keys
(`core/kernel/sources.constants`).
"""

from __future__ import annotations

import builtins
import functools
import inspect
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import BuiltinFunctionType, FunctionType, ModuleType
from typing import Any, NamedTuple

from cratous.core.kernel import Fold
from cratous.core.kernel.sources import PACKAGES, names_of, ours, runs_as_written
from cratous.core.ledger.meant_methods import other_methods
from cratous.core.ledger.tables import Unit, table


class _Meant(NamedTuple):
    """What a name refers to according to a file. module, name: where it is defined, or imported from."""

    kind: str
    module: str
    name: str


class _Said(NamedTuple):
    """What a file binds. meant: names bound to functions, classes and imports.

    hides: builtins that one of its own names may shadow.
    """

    meant: dict[str, tuple[_Meant, ...]]
    hides: frozenset[str]


MADE = ("ExceptionGroup", "copyright", "credits", "exit", "help", "license", "quit")
"""Names that Python creates at start-up: no kernel calls any of them."""
HEAP_TYPE = 1 << 9
"""Type flag: created by a class statement or in the same way."""
ALIASES = ("IOError", "EnvironmentError")
BUILTINS = frozenset(name for name in vars(builtins) if not name.startswith("__"))


@functools.cache
def _file_says(module: str) -> _Said:
    file = Path(str(sys.modules[module].__file__))
    package = file.name == "__init__.py"
    read = table(file.read_bytes(), module, package)
    found = {}
    for name, numbers in read.bound.items():
        units = [read.units[number] for number in numbers]
        if all(unit.kind in ("function", "class", "import") for unit in units):
            found[name] = tuple(_meant(unit, module, name) for unit in units)
    return _Said(found, BUILTINS if read.stars else BUILTINS & frozenset(read.bound))


def _meant(unit: Unit, module: str, name: str) -> _Meant:
    if unit.kind != "import":
        return _Meant(unit.kind, module, name)
    _, source, there = unit.imports[0]
    return _Meant("import", source, there)


Looked = dict[Any, tuple[str, ...]]
"""Cached results for functions and classes, many of which are shared dependencies."""


def replaced(rests: Iterable[Any], looked: Looked) -> list[str]:
    """Names that differ from their files, in the functions and classes among these dependencies."""
    found: set[str] = set()
    for value in rests:
        function = inspect.isfunction(value)
        if function or inspect.isclass(value):
            if value not in looked:
                looked[value] = tuple(_of(value) if function else other_methods(value))
            found.update(looked[value])
    return sorted(found)


def _of(function: FunctionType) -> Iterator[str]:
    module, scope = function.__module__, function.__globals__
    said = _file_says(module)
    names = tuple(names_of(function.__code__))
    # names that an interpreter has and its stubs do not
    whole: Any = function
    if whole.__builtins__ is not vars(builtins):
        yield f"{module}.__builtins__"
    for used in names:
        if used not in scope:
            if used in BUILTINS and used not in ALIASES and not _is_pythons(used):
                yield f"builtins.{used}"
            continue
        value = scope[used]
        if used in said.meant:
            if not _is_one(value, said.meant[used]):
                yield f"{module}.{used}"
            elif isinstance(value, ModuleType) and value.__name__.split(".")[0] in PACKAGES:
                yield from _within(value, names)
        elif used in BUILTINS and used not in said.hides and not _part(module, used, value):
            yield f"{module}.{used}"


def _is_pythons(name: str) -> bool:
    """Whether an interpreter name refers to the interpreter's own function or type, or to nothing callable."""
    value = vars(builtins).get(name)
    return not callable(value) or name in MADE or _is_called(value, name)


def _is_called(value: Any, name: str) -> bool:
    """Whether it is a C function or type of this name, which no package can create."""
    own = isinstance(value, BuiltinFunctionType)
    own = own or (isinstance(value, type) and not value.__flags__ & HEAP_TYPE)
    return own and value.__name__ == name


def _within(module: ModuleType, names: tuple[str, ...]) -> Iterator[str]:
    """The attributes, of those looked up in one of our modules, that differ from its file."""
    meant, scope = _file_says(module.__name__).meant, vars(module)
    for used in names:
        if used in meant and used in scope and not _is_one(scope[used], meant[used]):
            yield f"{module.__name__}.{used}"


def _part(module: str, name: str, value: Any) -> bool:
    """Whether a name is a submodule of a package, which its file need not mention."""
    return isinstance(value, ModuleType) and sys.modules.get(f"{module}.{name}") is value


def _is_one(value: Any, meant: tuple[_Meant, ...]) -> bool:
    return any(_is(value, one) for one in meant)


def _is(value: Any, meant: _Meant) -> bool:
    if meant.kind == "import":
        return _is_imported(value, meant)
    named = (getattr(value, "__module__", None), getattr(value, "__qualname__", None))
    # a decorator's own object has the name of what it decorates, or has no name
    if not inspect.isfunction(value) and not inspect.isclass(value) and named == (None, None):
        return not isinstance(value, ModuleType)
    if isinstance(value, Fold):
        return True
    return named == (meant.module, meant.name) and (
        not inspect.isfunction(value) or not ours(value) or runs_as_written(value)
    )


def _is_imported(value: Any, meant: _Meant) -> bool:
    source = sys.modules.get(meant.module)
    if source is None:
        return True  # its module was not imported, or is no longer there
    if not meant.name:
        return value is source
    if _part(meant.module, meant.name, value):
        return True
    if meant.name not in vars(source):  # what its package gives out when it is asked
        return not isinstance(value, ModuleType)
    if vars(source)[meant.name] is not value:
        return False
    if meant.module.split(".")[0] not in PACKAGES:
        # the library's own are not Python functions
        return meant.module != "math" or not callable(value) or _is_called(value, meant.name)
    # its own module may have been given a replacement as well
    said = _file_says(meant.module).meant.get(meant.name)
    return said is None or _is_one(value, said)
