"""Names in running functions that mean something else than the files of their modules say.

A function's own code may be its file's while its module was given another helper under the same name, which
then runs in the helper's place; so may a class be given another method. Held against the file are functions,
classes with their methods and fields, modules, what is imported from one, and the names of builtins; values
are part of the keys (`core/kernel/sources.constants`).
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
    """What a file says of a name. module, name: where it is defined, or imported from."""

    kind: str
    module: str
    name: str


class _Said(NamedTuple):
    """What a file says. meant: the names that it binds to functions, classes and what it imports.

    hides: builtins that a name of its own may stand for.
    """

    meant: dict[str, tuple[_Meant, ...]]
    hides: frozenset[str]


MADE = ("ExceptionGroup", "copyright", "credits", "exit", "help", "license", "quit")
"""What Python makes as it starts: no kernel calls any of it."""
HEAP_TYPE = 1 << 9
"""Of the flags of a type: it was made by a class statement or as one would make it."""
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
"""What was found of functions and classes so far: many rest on the same ones."""


def replaced(rests: Iterable[Any], looked: Looked) -> list[str]:
    """Names that are not what their files say, of functions and classes that something rests on."""
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
    # what an interpreter has and its stubs do not
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
    """A name of the interpreter's means what it is called: its own function or type, or nothing to call."""
    value = vars(builtins).get(name)
    return not callable(value) or name in MADE or _is_called(value, name)


def _is_called(value: Any, name: str) -> bool:
    """A function or type in C of this name: none that a package can make."""
    own = isinstance(value, BuiltinFunctionType)
    own = own or (isinstance(value, type) and not value.__flags__ & HEAP_TYPE)
    return own and value.__name__ == name


def _within(module: ModuleType, names: tuple[str, ...]) -> Iterator[str]:
    """What a module of ours is asked for by name is what its file says."""
    meant, scope = _file_says(module.__name__).meant, vars(module)
    for used in names:
        if used in meant and used in scope and not _is_one(scope[used], meant[used]):
            yield f"{module.__name__}.{used}"


def _part(module: str, name: str, value: Any) -> bool:
    """A package names its own modules, without a word in its file."""
    return isinstance(value, ModuleType) and sys.modules.get(f"{module}.{name}") is value


def _is_one(value: Any, meant: tuple[_Meant, ...]) -> bool:
    return any(_is(value, one) for one in meant)


def _is(value: Any, meant: _Meant) -> bool:
    if meant.kind == "import":
        return _is_imported(value, meant)
    named = (getattr(value, "__module__", None), getattr(value, "__qualname__", None))
    # a decorator's own object has the name of what it marks, or is none that has a name
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
        # the library's own are no functions of Python's
        return meant.module != "math" or not callable(value) or _is_called(value, meant.name)
    # its own module may have been given another thing as well
    said = _file_says(meant.module).meant.get(meant.name)
    return said is None or _is_one(value, said)
