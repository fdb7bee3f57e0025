"""Hashes of what source code means: syntax trees without comments, layout or docstrings.

Used by the ledger: a kernel's key must change with anything that could change its meaning, and
with nothing else. Closures follow the `import` statements inside the product and inside packages
that add kernels of their own (`add_package`). `altered` holds the code that runs against the file
that is hashed, so that stale or planted byte code cannot stand in for the source.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib
import inspect
import os
import sys
import textwrap
import types
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, get_type_hints

from cratous.core.kernel import Fold, qualified

ROOT = Path(__file__).resolve().parents[2]
"""The folder that holds core, spec, proofs (the repository, or the installed package)."""

PACKAGES: dict[str, Path] = {"cratous": ROOT}
"""The packages whose sources count, with their folders."""

CONSTANTS = (bool, int, float, str, bytes, tuple, frozenset, Fraction, type(None))


def digest(parts: Iterable[str]) -> str:
    """One SHA-256 over several texts; the boundaries between them count."""
    sha = hashlib.sha256()
    for part in parts:
        data = part.encode()
        sha.update(str(len(data)).encode() + b":" + data)
    return sha.hexdigest()


def add_package(name: str, folder: Path) -> None:
    """Let the sources of another package count as the product's own do."""
    PACKAGES[name] = folder.resolve()
    imports.cache_clear()


def ours(value: Any) -> bool:
    """True iff a function or class comes from the product or an added package."""
    return str(getattr(value, "__module__", "")).split(".")[0] in PACKAGES


def place(file: Path) -> str:
    """A file's name for people and for hashes: relative to its package, without the machine."""
    return _place(file, tuple(PACKAGES.items()))


@functools.cache
def _place(file: Path, packages: tuple[tuple[str, Path], ...]) -> str:
    for name, root in packages:
        if file.is_relative_to(root):
            inside = file.relative_to(root).as_posix()
            return inside if name == "cratous" else f"{name}/{inside}"
    return file.name


def position(function: Any) -> str:
    """Where a function, fold or class stands, as `core/authority/gate.py:24`."""
    if isinstance(function, Fold):
        function = function.step
    try:
        file = Path(inspect.getsourcefile(function) or "?").resolve()
        return f"{place(file)}:{inspect.getsourcelines(function)[1]}"
    except OSError:
        return f"{function.__module__} (no source)"


def module_file(name: str) -> Path | None:
    """The source file of a module of ours; None for anything else."""
    parts = name.split(".")
    root = PACKAGES.get(parts[0])
    if root is None:
        return None
    base = root.joinpath(*parts[1:])
    for file in (base.with_suffix(".py"), base / "__init__.py"):
        if len(parts) > 1 and file.is_file():
            return file
    return None


def _strip_docstrings(tree: ast.AST) -> ast.AST:
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.FunctionDef | ast.ClassDef):
            body = node.body
            if body and isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant):
                node.body = body[1:] or [ast.Pass()]
    return tree


def tree_text(source: str, *, docstrings: bool = False) -> str:
    """The syntax tree as text; docstrings only if they matter (a theorem's is its sentence)."""
    tree: ast.AST = ast.parse(source)
    return ast.dump(tree if docstrings else _strip_docstrings(tree))


def tree(path: Path, *, docstrings: bool = True) -> ast.Module:
    """The syntax tree of a file as it is now; shared, so it must not be changed."""
    stat = os.stat(path)
    return _tree(path, docstrings, stat.st_mtime_ns, stat.st_size)


@functools.cache
def _tree(path: Path, docstrings: bool, changed_ns: int, size: int) -> ast.Module:
    parsed = ast.parse(path.read_text(encoding="utf-8"))
    if not docstrings:
        _strip_docstrings(parsed)
    return parsed


@functools.cache
def file_text(path: Path, docstrings: bool = False) -> str:
    """The syntax tree of a file as text."""
    return ast.dump(tree(path, docstrings=docstrings))


def imported(path: Path) -> tuple[tuple[str, str], ...]:
    """(module, name) of every import in a file; name is empty for `import module`."""
    return _imported(path, tree(path))


@functools.cache
def _imported(path: Path, parsed: ast.Module) -> tuple[tuple[str, str], ...]:
    return tuple(_import_statements(path, parsed))


def _import_statements(path: Path, parsed: ast.Module) -> Iterator[tuple[str, str]]:
    for node in ast.walk(parsed):
        if isinstance(node, ast.Import):
            yield from ((alias.name, "") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = node.module or ""
            if node.level:
                package = _package_of(path)
                up = package[: len(package) - node.level + 1]
                module = ".".join([*up, *([module] if module else [])])
            yield from ((module, alias.name) for alias in node.names)


def _package_of(path: Path) -> list[str]:
    for name, root in PACKAGES.items():
        if path.is_relative_to(root):
            return [name, *path.relative_to(root).parts[:-1]]
    return []


@functools.cache
def imports(path: Path) -> tuple[Path, ...]:
    """The files of the product that a file imports, at the top or anywhere inside."""
    found = set()
    for module, name in imported(path):
        for candidate in (module, f"{module}.{name}"):
            file = module_file(candidate)
            if file is not None:
                found.add(file)
    return tuple(sorted(found))


def closure(*paths: Path) -> tuple[Path, ...]:
    """Files and everything of the product that they import, directly or not."""
    seen: set[Path] = set()
    todo = list(paths)
    while todo:
        file = todo.pop()
        if file not in seen:
            seen.add(file)
            todo += imports(file)
    return tuple(sorted(seen))


def files_digest(files: Iterable[Path], *, docstrings: bool = False) -> str:
    """One hash over the meaning of several files, names included."""
    parts = []
    for file in files:
        parts += [place(file), file_text(file, docstrings)]
    return digest(parts)


def reached(item: Any) -> dict[str, Any]:
    """All functions, classes and constants that a function or fold rests on, itself included."""
    seen: dict[str, Any] = {}
    todo: list[Any] = [item]
    while todo:
        value = todo.pop()
        if isinstance(value, Fold):
            seen[f"fold {qualified(value)}"] = (
                value.start, qualified(value.step), qualified(value.finish),
            )  # fmt: skip
            todo += [value.step, value.finish]
            continue
        name = f"{value.__module__}.{value.__qualname__}"
        if name in seen:
            continue
        seen[name] = value
        if inspect.isclass(value):
            # what dataclass and NamedTuple generate follows from the class's own source
            own = [f for f in vars(value).values() if inspect.isfunction(f) and ours(f)]
            file = str(sys.modules[value.__module__].__file__)
            todo += [f for f in own if f.__code__.co_filename == file]
            continue
        scope = value.__globals__
        for used in _names(value.__code__):
            found = scope.get(used)
            callee = ours(found) and (inspect.isfunction(found) or inspect.isclass(found))
            if callee or isinstance(found, Fold):
                todo.append(found)
            elif used in scope and isinstance(found, CONSTANTS):
                seen[f"{value.__module__}.{used}"] = found
        # a record that only stands in an annotation still gives its fields their order
        hints = get_type_hints(value).values()
        todo += [hint for hint in hints if inspect.isclass(hint) and ours(hint)]
    return seen


def _names(code: types.CodeType) -> Iterator[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _names(constant)


def function_parts(function: Callable[..., Any] | Fold[Any] | type) -> list[str]:
    """The syntax trees of a function and of all that it calls or constructs, by name."""
    parts = []
    for name, value in sorted(reached(function).items()):
        if inspect.isfunction(value) or inspect.isclass(value):
            item: Any = value
            parts.append(f"{name}={_source(item, getattr(item, '__code__', None))}")
        else:
            parts.append(f"{name}={type(value).__name__} {value!r}")
    return parts


@functools.cache
def _source(value: Any, code: types.CodeType | None) -> str:
    """The tree of a function or class; code: what a function runs now, so that it is read anew."""
    try:
        file = code.co_filename if code else str(sys.modules[value.__module__].__file__)
        name = (code.co_qualname, code.co_firstlineno) if code else (value.__qualname__, 0)
        stat = os.stat(file)
        nodes = _defined(Path(file), stat.st_mtime_ns, stat.st_size).get(name, ())
        if len(nodes) == 1:
            return ast.dump(ast.Module([nodes[0]], []))
        return tree_text(textwrap.dedent(inspect.getsource(value)))
    except (OSError, SyntaxError):
        return "no source"  # made at run time: it equals nothing that was proved


@functools.cache
def _defined(file: Path, changed_ns: int, size: int) -> dict[tuple[str, int], list[ast.stmt]]:
    """Every function and class of a file without docstrings, by qualified name and first line.

    The line of a class counts as 0: the class itself does not know it.
    """
    found: dict[tuple[str, int], list[ast.stmt]] = {}

    def look(node: ast.AST, inside: str) -> None:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
                name = inside + child.name
                first = min([child.lineno, *(mark.lineno for mark in child.decorator_list)])
                found.setdefault((name, first), []).append(child)
                look(child, f"{name}.<locals>.")
            elif isinstance(child, ast.ClassDef):
                found.setdefault((inside + child.name, 0), []).append(child)
                look(child, f"{inside}{child.name}.")
            else:
                look(child, inside)

    look(tree(file, docstrings=False), "")
    return found


def statement_parts(path: Path, engine: frozenset[Path]) -> list[str]:
    """What a theorem file says: its tree, its sentence, and all that it takes from elsewhere.

    engine: files that are hashed as the prover and therefore not here.
    """
    parts = [place(path), file_text(path, True)]
    for module, name in sorted(set(imported(path))):
        submodule = module_file(f"{module}.{name}") if name else module_file(module)
        file = submodule or module_file(module)
        if file is None or file in engine:
            continue
        value = None if submodule else getattr(importlib.import_module(module), name, None)
        if isinstance(value, Fold) or inspect.isfunction(value) or inspect.isclass(value):
            parts += function_parts(value)
        elif value is not None and isinstance(value, CONSTANTS):
            parts.append(f"{module}.{name}={type(value).__name__} {value!r}")
        else:
            parts.append(files_digest(f for f in closure(file) if f not in engine))
    return parts


# -- the code that runs against the file that was hashed -------------------------------------
@functools.cache
def _written(file: Path) -> dict[tuple[str, int], types.CodeType]:
    """Every code object that a file compiles to, by qualified name and line."""
    found: dict[tuple[str, int], types.CodeType] = {}
    todo = [compile(file.read_text(encoding="utf-8"), str(file), "exec", dont_inherit=True)]
    while todo:
        code = todo.pop()
        found[code.co_qualname, code.co_firstlineno] = code
        todo += [c for c in code.co_consts if isinstance(c, types.CodeType)]
    return found


def _same_code(a: types.CodeType, b: types.CodeType) -> bool:
    if (a.co_code, a.co_names, a.co_varnames, a.co_freevars, len(a.co_consts)) != (
        b.co_code, b.co_names, b.co_varnames, b.co_freevars, len(b.co_consts),
    ):  # fmt: skip
        return False
    for one, other in zip(a.co_consts, b.co_consts, strict=True):
        if isinstance(one, types.CodeType) and isinstance(other, types.CodeType):
            if not _same_code(one, other):
                return False
        elif type(one) is not type(other) or one != other:
            return False
    return True


def altered(item: Callable[..., Any] | Fold[Any]) -> list[str]:
    """Functions that do not run what their source file says, of `item` and all it rests on."""
    wrong = []
    for name, value in reached(item).items():
        if not inspect.isfunction(value):
            continue
        file = Path(str(sys.modules[value.__module__].__file__)).resolve()
        code = value.__code__
        written = _written(file).get((code.co_qualname, code.co_firstlineno))
        if written is None or not _same_code(code, written):
            wrong.append(name)
    return sorted(wrong)
