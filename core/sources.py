"""Hashes of what source code means: syntax trees without comments, layout or docstrings.

Used by the ledger: a kernel's key must change with anything that could change its meaning, and
with nothing else. Closures follow the `import` statements inside the product.
"""

from __future__ import annotations

import ast
import functools
import hashlib
import inspect
import textwrap
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
"""The folder that holds core, spec, proofs (the repository, or the installed package)."""


def digest(parts: Iterable[str]) -> str:
    """One SHA-256 over several texts; the boundaries between them count."""
    sha = hashlib.sha256()
    for part in parts:
        data = part.encode()
        sha.update(str(len(data)).encode() + b":" + data)
    return sha.hexdigest()


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


@functools.cache
def file_text(path: Path, docstrings: bool = False) -> str:
    """The syntax tree of a file as text."""
    return tree_text(path.read_text(encoding="utf-8"), docstrings=docstrings)


@functools.cache
def imports(path: Path) -> tuple[Path, ...]:
    """The files of the product that a file imports, at the top or anywhere inside."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names: list[str] = []
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names = [node.module] + [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        for name in names:
            parts = name.split(".")
            if parts[0] == "cratous" and len(parts) > 1:
                file = ROOT.joinpath(*parts[1:]).with_suffix(".py")
                if file.is_file():
                    found.append(file)
    return tuple(sorted(set(found)))


def closure(path: Path) -> tuple[Path, ...]:
    """A file and everything of the product that it imports, directly or not."""
    seen: set[Path] = set()
    todo = [path]
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
        parts += [file.relative_to(ROOT).as_posix(), file_text(file, docstrings)]
    return digest(parts)


def function_parts(function: Callable[..., Any]) -> list[str]:
    """The syntax trees of a function and of all that it calls or constructs, by name."""
    seen: dict[str, str] = {}
    todo: list[Any] = [function]
    while todo:
        item = todo.pop()
        name = f"{item.__module__}.{item.__qualname__}"
        if name in seen:
            continue
        seen[name] = tree_text(textwrap.dedent(inspect.getsource(item)))
        if inspect.isclass(item):
            continue
        scope = item.__globals__
        for used in item.__code__.co_names:
            value = scope.get(used)
            ours = getattr(value, "__module__", "").startswith("cratous.")
            if ours and (inspect.isfunction(value) or inspect.isclass(value)):
                todo.append(value)
            elif isinstance(value, int | str | tuple):
                seen[f"{item.__module__}.{used}"] = repr(value)
    return [f"{name}={text}" for name, text in sorted(seen.items())]
