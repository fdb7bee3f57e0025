"""What the names in a theorem's file may refer to: kernels, definitions, records and numbers only.

`theorem_subset` checks the syntax; this checks the values that the syntax reaches: the file's imports, and the
attributes of imported modules.
"""

from __future__ import annotations

import ast
import sys
import types
import typing
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

from cratous.core.kernel import Fold, entry_of
from cratous.core.kernel.sources import PACKAGES, ours, place
from cratous.proofs.engine import definition_subset, theorem_subset
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.definition_subset import of_theorems
from cratous.proofs.engine.value_kinds import is_record
from cratous.spec.errors import BadInput

TOOLS = {
    "__future__": ("annotations",),
    "collections.abc": ("Callable", "Iterable", "Iterator", "Mapping", "Sequence"),
    "fractions": ("Fraction",),
    "itertools": ("combinations", "pairwise", "product"),
    "math": ("sqrt",),
    "typing": ("Any",),
}
"""What a theorem may import from Python's standard library."""
WANTED = "kernels as they are registered, folds, functions and modules of `spec`, records, numbers"


def check_values(scope: dict[str, Any], tree: ast.Module, path: Path) -> None:
    """Raise BadInput, with the line, for a file whose names refer to anything else.

    scope: its globals. A function of `spec` that the theorem uses other than by c.define is held to the definition
    subset; a file of theorems that it imports from is checked like a theorem.
    """

    def refuse(node: ast.AST, what: str) -> typing.NoReturn:
        line = getattr(node, "lineno", 1)
        raise BadInput(what, where=f"{place(path)}:{line}", expected=WANTED)

    for imported in (node for node in tree.body if isinstance(node, ast.ImportFrom)):
        for alias in imported.names:
            value, module = scope[alias.asname or alias.name], str(imported.module)
            if alias.name not in TOOLS.get(module, ()) and not _may_be_used(value):
                refuse(imported, f"a theorem's file does not import {alias.name!r} of {module}")
            if isinstance(value, types.FunctionType) and of_theorems(value):
                _check_file(value.__module__)
    defined = {id(node) for node in _defined(tree)}
    types_ = {id(part) for node in _annotations(tree) for part in ast.walk(node)}
    for node in ast.walk(tree):
        found, value = _meant(node, scope)
        if not found:
            continue
        if value is Claim and id(node) not in types_:
            refuse(node, "a theorem makes no claim of its own: it is given one")
        if isinstance(node, ast.Attribute) and not _may_be_used(value):
            refuse(node, f"a theorem's file does not use {ast.unparse(node)!r}")
        # what a kernel has outside of the subset is reported where it is lifted
        plain = isinstance(value, types.FunctionType) and not of_theorems(value)
        plain = plain and entry_of(value) is None
        if plain and id(node) not in defined and (out := definition_subset.outside(value)):
            refuse(node, f"a theorem uses what is outside of the subset: {out[0]}")


def _may_be_used(value: Any) -> bool:
    if isinstance(value, types.ModuleType):
        parts = value.__name__.split(".")
        # a module of core, or of a package's kernels, has kernels and drivers; only kernels are permitted
        return parts[0] in PACKAGES and parts[1:2] not in (["proofs"], ["services"], ["bridge"])
    entry = entry_of(value)
    if entry is not None:
        return entry.kind != "driver"
    if value is Claim or value is Fold or is_record(value) or _of_methods(value):
        return True
    if isinstance(value, bool | int | float | Fraction | str):
        return True
    if isinstance(value, dict | tuple | frozenset | list):
        inner: Iterable[Any] = value.items() if isinstance(value, dict) else value
        return all(map(_may_be_used, inner))
    if isinstance(value, types.FunctionType) and ours(value):
        return of_theorems(value) or value.__module__.split(".")[1:2] == ["spec"]
    return typing.get_origin(value) is not None


def _of_methods(value: Any) -> bool:
    """Whether the value is a named tuple of the kind that methods of proof take."""
    home = str(getattr(value, "__module__", ""))
    named = isinstance(value, type) and value.__bases__ == (tuple,)
    return named and home.startswith("cratous.proofs.methods.")


def _meant(node: ast.AST, scope: dict[str, Any]) -> tuple[bool, Any]:
    """Whether a node is a name of the file or an attribute of one of its modules, and the value."""
    if isinstance(node, ast.Name):
        return node.id in scope, scope.get(node.id)
    if isinstance(node, ast.Attribute):
        found, owner = _meant(node.value, scope)
        if found and isinstance(owner, types.ModuleType):
            return True, vars(owner).get(node.attr, owner)
    return False, None


def _defined(tree: ast.Module) -> Iterator[ast.expr]:
    """The arguments of c.define in the file."""
    for node in ast.walk(tree):
        by = node.func if isinstance(node, ast.Call) and node.args else None
        if isinstance(by, ast.Attribute) and by.attr == "define":
            assert isinstance(node, ast.Call)
            yield node.args[0]


def _annotations(tree: ast.Module) -> Iterator[ast.expr]:
    """The type annotations in a file."""
    for node in ast.walk(tree):
        if isinstance(node, ast.arg | ast.AnnAssign) and node.annotation is not None:
            yield node.annotation
        if isinstance(node, ast.FunctionDef) and node.returns is not None:
            yield node.returns


_CHECKED: set[tuple[str, int]] = set()


def _check_file(module: str) -> None:
    """Check another file of theorems from which a function is imported."""
    scope = vars(sys.modules[module])
    path = Path(str(scope["__file__"]))
    known = (module, id(scope))
    if known in _CHECKED or module.startswith("cratous.proofs.methods"):
        return  # methods of proof are a part of the prover
    _CHECKED.add(known)
    tree = ast.parse(path.read_text(encoding="utf-8"))
    theorem_subset.check(tree, path)
    check_values(scope, tree, path)
