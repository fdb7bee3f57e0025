"""What the names in a theorem's file may refer to: kernels, definitions, records and numbers only.

`theorem_subset` checks the syntax; this checks the values that the syntax reaches: the file's imports, and the
attributes of imported modules. Values are of Python's own types or records, never of a class that could tell who
reads the claim; constants of other modules are what their files write.
"""

from __future__ import annotations

import ast
import sys
import types
import typing
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

from cratous.core.kernel import Fold, entry_of
from cratous.core.kernel.sources import PACKAGES, ours, place
from cratous.proofs.engine import definition_subset, theorem_subset
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.definition_subset import of_theorems
from cratous.proofs.engine.module_source import constant
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
NUMBERS = (bool, int, float, Fraction, str)
ALIASES = frozenset(
    map(
        type,
        (list[int], int | str, Callable[[int], int], typing.Callable[[int], int]),
    )
)
"""The types of what stands for a type in an annotation."""
ATTRIBUTES: tuple[tuple[type, frozenset[str]], ...] = (
    (types.FunctionType, frozenset(["__name__"])),
    (Fold, frozenset(["step", "finish", "start"])),
    (str, frozenset(["split", "join"])),
    (dict, frozenset(["items", "keys", "values"])),
)
"""What a theorem may use of a value that its file names."""
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
            if module not in TOOLS and not _as_written(sys.modules[module], alias.name, value):
                refuse(imported, f"{alias.name!r} of {module} is not what its file writes")
            if isinstance(value, types.FunctionType) and of_theorems(value):
                _check_file(value.__module__)
    defined = {id(node) for node in _defined(tree)}
    types_ = {id(part) for node in _annotations(tree) for part in ast.walk(node)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and not _is_of(node, scope):
            refuse(node, f"a theorem's file does not use {ast.unparse(node)!r}")
        found, value = _meant(node, scope)
        if not found:
            continue
        if value is Claim and id(node) not in types_:
            refuse(node, "a theorem makes no claim of its own: it is given one")
        if isinstance(node, ast.Attribute):
            if not _may_be_used(value):
                refuse(node, f"a theorem's file does not use {ast.unparse(node)!r}")
            if not _as_written(_meant(node.value, scope)[1], node.attr, value):
                refuse(node, f"{ast.unparse(node)!r} is not what its file writes")
        if type(value) in ALIASES and id(node) not in types_:
            refuse(node, "a theorem uses a type only in an annotation")
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
    if type(value) in NUMBERS or type(value) in ALIASES:
        return True
    if type(value) is dict:
        return all(map(_may_be_used, value.items()))
    if type(value) in (tuple, list) or is_record(type(value)) or _of_methods(type(value)):
        return all(map(_may_be_used, value))
    if isinstance(value, types.FunctionType) and ours(value):
        return of_theorems(value) or value.__module__.split(".")[1:2] == ["spec"]
    return False


def _as_written(module: Any, name: str, value: Any) -> bool:
    """Whether a constant of another module is the one that its file writes; true of anything but a constant."""
    if not isinstance(module, types.ModuleType) or module.__name__.startswith(
        ("cratous.proofs.methods", "cratous.proofs.theorems")
    ):
        return True
    if type(value) in (dict, list):
        return False  # it could be changed by whoever has it too
    if type(value) not in NUMBERS and not isinstance(value, tuple):
        return True
    said = constant(module, name, is_record=is_record)
    return type(said) is type(value) and bool(said == value)


def _is_of(node: ast.Attribute, scope: dict[str, Any]) -> bool:
    """Whether an attribute is of a module, of a value that the file does not name, or a field or part of one."""
    found, value = _meant(node.value, scope)
    if not found or isinstance(value, types.ModuleType):
        return True
    if is_record(type(value)) or _of_methods(type(value)):
        return node.attr in value._fields
    return any(type(value) is kind and node.attr in names for kind, names in ATTRIBUTES)


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
