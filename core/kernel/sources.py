"""Functions as they run, and what they depend on.

Used by the ledger, whose keys are hashes of text (`core/ledger/keys.py`): `constants` are the values that a function
depends on, and `altered` compares the code that runs with the file that is hashed, so that stale or planted byte code
cannot replace the source. Only functions of the product, and of packages with kernels of their own (`add_package`),
are considered.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import inspect
import json
import linecache
import os
import sys
import textwrap
import types
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any, get_type_hints

from cratous.core.files.private_cache import private_cache
from cratous.core.kernel import Fold, qualified

ROOT = Path(__file__).resolve().parents[2]
"""The folder that holds core, spec, proofs (the repository, or the installed package)."""

PACKAGES: dict[str, Path] = {"cratous": ROOT}
"""The packages whose sources are considered, with their folders."""

CONSTANTS = (bool, int, float, str, bytes, tuple, frozenset, Fraction, type(None))


def digest(parts: Iterable[str]) -> str:
    """One SHA-256 over several texts, including the boundaries between them."""
    sha = hashlib.sha256()
    for part in parts:
        data = part.encode()
        sha.update(str(len(data)).encode() + b":" + data)
    return sha.hexdigest()


def add_package(name: str, folder: Path) -> None:
    """Have the sources of another package considered like the product's own."""
    PACKAGES[name] = folder.resolve()


def ours(value: Any) -> bool:
    """True iff a function or class comes from the product or an added package."""
    return str(getattr(value, "__module__", "")).split(".")[0] in PACKAGES


def place(file: Path) -> str:
    """A file's name for display and for hashes: relative to its package, independent of the machine."""
    return _place(file, tuple(PACKAGES.items()))


@functools.cache
def _place(file: Path, packages: tuple[tuple[str, Path], ...]) -> str:
    for name, root in packages:
        if file.is_relative_to(root):
            inside = file.relative_to(root).as_posix()
            return inside if name == "cratous" else f"{name}/{inside}"
    return file.name


def text_of(function: Any) -> str:
    """The text of a function in its file as it is now. Raises OSError if there is none, TypeError.

    Lines that an import may have put into `linecache` for the file are ignored.
    """
    inner = inspect.unwrap(function)
    linecache.cache.pop(inspect.getsourcefile(inner) or "", None)
    return textwrap.dedent(inspect.getsource(inner))


def is_root(value: Any) -> bool:
    """Whether it is the library's own `math.sqrt`, which a package may have replaced."""
    builtin = isinstance(value, types.BuiltinFunctionType)
    return builtin and (value.__module__, value.__name__) == ("math", "sqrt")


def position(function: Any) -> str:
    """Location of a function, fold or class, such as `core/authority/gate.py:24`."""
    if isinstance(function, Fold):
        function = function.step
    try:
        file = Path(inspect.getsourcefile(function) or "?").resolve()
        return f"{place(file)}:{inspect.getsourcelines(function)[1]}"
    except OSError:
        return f"{function.__module__} (no source)"


def reached(item: Any) -> dict[str, Any]:
    """All functions, classes and constants that a function or fold depends on, including itself."""
    seen: dict[str, Any] = {}
    todo: list[Any] = [item]
    while todo:
        value = todo.pop()
        if isinstance(value, Fold):
            seen[f"fold {qualified(value)}"] = (
                value.start, *(qualified(part) for part in value.kernels),
            )  # fmt: skip
            todo += value.kernels
            continue
        name = f"{value.__module__}.{value.__qualname__}"
        if name in seen:
            continue
        seen[name] = value
        if inspect.isclass(value):
            # what dataclass and NamedTuple generate is determined by the class's own source
            own = [f for f in vars(value).values() if inspect.isfunction(f) and ours(f)]
            file = str(sys.modules[value.__module__].__file__)
            todo += [f for f in own if f.__code__.co_filename == file]
            continue
        held = _held(value)
        scope = {**value.__globals__, **held}
        for used in (*names_of(value.__code__), *held):
            found = scope.get(used)
            callee = ours(found) and (inspect.isfunction(found) or inspect.isclass(found))
            if callee or isinstance(found, Fold):
                todo.append(found)
            elif used in scope and isinstance(found, CONSTANTS):
                owner = f"{name} " if used in held else f"{value.__module__}."
                seen[f"{owner}{used}"] = found
        # a record that occurs only in an annotation still determines the order of its fields
        hints = get_type_hints(value).values()
        todo += [hint for hint in hints if inspect.isclass(hint) and ours(hint)]
    return seen


def _held(function: types.FunctionType) -> dict[str, Any]:
    """What a function itself refers to, apart from its module: closure, defaults, wrapped function."""
    code, defaults = function.__code__, function.__defaults__ or ()
    named = code.co_varnames[: code.co_argcount]
    held = dict(zip(named[len(named) - len(defaults) :], defaults, strict=True))
    held |= function.__kwdefaults__ or {}
    held = {f"{name} by default": value for name, value in held.items()}
    for name, cell in zip(code.co_freevars, function.__closure__ or (), strict=True):
        with contextlib.suppress(ValueError):  # it is empty yet
            held[name] = cell.cell_contents
    if "__wrapped__" in vars(function):
        held["__wrapped__"] = function.__wrapped__  # type: ignore[attr-defined]
    return held


def names_of(code: types.CodeType) -> Iterator[str]:
    """The names that a code object and the functions within it look up."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from names_of(constant)


def constants(item: Any) -> list[str]:
    """The values of all constants that a function or fold depends on, in an order independent of their location."""
    return constants_of(reached(item))


def constants_of(rests: Mapping[str, Any]) -> list[str]:
    """The constants among things already `reached`."""
    found = []
    for name, value in rests.items():
        last = name.rpartition(".")[2]
        if name.startswith("fold "):
            found.append(f"start {_shown(value[0])}")
        elif isinstance(value, CONSTANTS) and not last.startswith("__"):
            found.append(f"{last}={type(value).__name__} {_shown(value)}")
    return sorted(found)


def _shown(value: Any) -> str:
    if isinstance(value, frozenset):
        return f"{{{', '.join(sorted(map(_shown, value)))}}}"
    if isinstance(value, tuple):
        return f"({', '.join(map(_shown, value))})"
    return repr(value)


# -- the code that runs against the file that was hashed -------------------------------------
@functools.cache
def _written(file: Path) -> dict[str, str]:
    """The hash of every code object that a file compiles to, by qualified name and line.

    Cached privately by the hash of the file's text: compiling all files takes a second.
    """
    data = file.read_bytes()
    maker = f"{sys.version} {sys.flags.optimize} {_hash.__code__.co_code!r}"
    key = digest([maker, str(file), hashlib.sha256(data).hexdigest()])
    kept = private_cache() / "codes" / key[:2] / key
    with contextlib.suppress(OSError, ValueError, AttributeError):
        return {str(n): str(h) for n, h in json.loads(kept.read_text(encoding="utf-8")).items()}
    found = {}
    todo = [compile(data, str(file), "exec", dont_inherit=True)]
    while todo:
        code = todo.pop()
        found[_name(code)] = _hash(code)
        todo += [c for c in code.co_consts if isinstance(c, types.CodeType)]
    with contextlib.suppress(OSError):  # a folder that cannot be written is no error
        kept.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        part = kept.with_name(f"{key}.{os.getpid()}")
        part.write_text(json.dumps(found), encoding="utf-8")
        part.replace(kept)
    return found


def written_names(file: str) -> list[str]:
    """The qualified names of all functions and classes that a file defines."""
    return [name.rpartition(":")[0] for name in _written(Path(file).resolve())]


def _name(code: types.CodeType) -> str:
    return f"{code.co_qualname}:{code.co_firstlineno}"


def _hash(code: types.CodeType) -> str:
    """A hash of what a code object does; line numbers and file names are ignored."""
    parts = [code.co_code.hex(), *map(repr, (code.co_names, code.co_varnames, code.co_freevars))]
    for value in code.co_consts:
        inner = _hash(value) if isinstance(value, types.CodeType) else _shown(value)
        parts.append(f"{type(value).__name__} {inner}")
    return digest(parts)


def stands_for_itself(function: Callable[..., Any]) -> bool:
    """Whether a function's module binds its name to it, so that callers reach it and not a wrapper."""
    if "." in function.__qualname__:
        return True
    return vars(sys.modules[function.__module__]).get(function.__name__) is function


def altered(item: Callable[..., Any] | Fold[Any]) -> list[str]:
    """The functions, of `item` and all it depends on, whose running code differs from their source file."""
    return altered_of(reached(item))


def altered_of(rests: dict[str, Any]) -> list[str]:
    """The altered functions among things already `reached`."""
    return sorted(
        name
        for name, value in rests.items()
        if inspect.isfunction(value) and not _as_written(value, value.__code__)
    )


@functools.cache
def _resolved(file: str) -> Path:
    """The resolved path of a module's file, cached: many functions share one, and resolving links is slow."""
    return Path(file).resolve()


@functools.cache
def _as_written(function: types.FunctionType, code: types.CodeType) -> bool:
    """Whether a function runs the code in its module's file, and the file lies where the module should.

    code: its present code, a cache key, so that a changed function is checked anew.
    """
    file = _resolved(str(sys.modules[function.__module__].__file__))
    top, *parts = function.__module__.split(".")
    if top in PACKAGES:
        base = PACKAGES[top].joinpath(*parts)
        if file not in (base.with_suffix(".py"), base / "__init__.py"):
            return False
    # the code of another function of the file is also as written, but not this one's
    own = (code.co_name, code.co_qualname) == (function.__name__, function.__qualname__)
    return own and _written(file).get(_name(code)) == _hash(code)


def runs_as_written(function: types.FunctionType) -> bool:
    """Whether a function runs the code in its module's file."""
    return _as_written(function, function.__code__)
