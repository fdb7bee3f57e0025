"""What a module's file gives for a name: one top-level definition, or one constant.

The running code is compared with this, so that changes which modules make to themselves or to each other on import do
not enter a proof.
"""

from __future__ import annotations

import ast
import functools
import inspect
import os
import sys
import types
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from cratous.core.kernel.sources import PACKAGES

NOTHING = object()
PARTS = (
    ast.Constant, ast.BinOp, ast.UnaryOp, ast.Tuple, ast.Name, ast.Call, ast.operator, ast.unaryop,
    ast.expr_context, ast.Starred,
)  # fmt: skip
IMPORTS = 10
KNOWN = {"Fraction": Fraction, "tuple": tuple, "range": range}


@functools.cache
def parsed(file: str, changed_ns: int) -> ast.Module:
    """The syntax of a file, read once for each time of its change [ns]."""
    with open(file, encoding="utf-8") as text:
        return ast.parse(text.read())


def is_top(function: types.FunctionType) -> bool:
    """Whether the function is the only top-level definition of its name in its file, and nothing else binds the
    name."""
    file = str(inspect.getsourcefile(function))
    found = _bindings(file, os.stat(file).st_mtime_ns).get(function.__name__, [])
    return len(found) == 1 and found[0]


@functools.cache
def _bindings(file: str, changed_ns: int) -> dict[str, list[bool]]:
    """All bindings of names in a file, outside of functions and classes; for each, whether it is a top-level `def`."""
    tree = parsed(file, changed_ns)
    inner = {
        id(n)
        for f in ast.walk(tree)
        if isinstance(f, ast.FunctionDef | ast.ClassDef)
        for b in f.body
        for n in ast.walk(b)
    }
    top = {id(n) for n in tree.body if isinstance(n, ast.FunctionDef)}
    found: dict[str, list[bool]] = {}
    for node in ast.walk(tree):
        name = _bound_name(node)
        if name and id(node) not in inner:
            found.setdefault(name, []).append(id(node) in top)
    return found


def _bound_name(node: ast.AST) -> str:
    """The name that a node binds; empty if none."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return node.name
    if isinstance(node, ast.alias):
        return node.asname or node.name
    return node.id if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) else ""


def constant(
    module: types.ModuleType,
    name: str,
    imports: int = IMPORTS,
    is_record: Callable[[Any], bool] = lambda _: False,
) -> Any:
    """The constant that a module's file binds to a name, followed through imports from other files.

    NOTHING where there is no such binding, or more than one. imports: the longest chain of imports that is followed;
    is_record: which classes of the module a constant may be made with.
    """
    file = str(module.__file__)
    changed_ns = os.stat(file).st_mtime_ns
    if len(_bindings(file, changed_ns).get(name, ())) != 1:
        return NOTHING
    found = _imported(file, changed_ns, name) if imports else None
    if found is None:
        said = _constants(file, changed_ns).get(name, NOTHING)
        made = {n: c for n, c in vars(module).items() if is_record(c)}
        return _record(file, changed_ns, name, made) if said is NOTHING and made else said
    home, its = found
    source = sys.modules.get(home) if home.split(".")[0] in PACKAGES else None
    return NOTHING if source is None else constant(source, its, imports - 1, is_record)


@functools.cache
def _constants(file: str, changed_ns: int) -> dict[str, Any]:
    known: dict[str, Any] = {}
    for node in parsed(file, changed_ns).body:
        if isinstance(node, ast.Assign):
            pairs = [(target, node.value) for target in node.targets]
        elif isinstance(node, ast.AnnAssign) and node.value is not None:
            pairs = [(node.target, node.value)]
        else:
            continue
        for target, value in pairs:
            if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
                both = list(zip(target.elts, value.elts, strict=False))
            else:
                both = [(target, value)]
            for one, said in both:
                if isinstance(one, ast.Name):
                    known[one.id] = NOTHING if one.id in known else _value(said, known)
    return known


def _record(file: str, changed_ns: int, name: str, made: dict[str, Any]) -> Any:
    """The record that a file binds to a name, made of written values; NOTHING if it is none."""
    for node in parsed(file, changed_ns).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == name:
            return _value(node.value, made)
    return NOTHING


def _imported(file: str, changed_ns: int, name: str) -> tuple[str, str] | None:
    """Module and original name from which a file imports a name, if once and at the top level."""
    found = [
        (str(node.module), alias.name)
        for node in parsed(file, changed_ns).body
        if isinstance(node, ast.ImportFrom) and not node.level
        for alias in node.names
        if (alias.asname or alias.name) == name
    ]
    once = len(_bindings(file, changed_ns).get(name, [])) == 1
    return found[0] if found and once else None


def _value(node: ast.expr, known: dict[str, Any]) -> Any:
    if not all(isinstance(part, PARTS) for part in ast.walk(node)):
        return NOTHING
    scope = {**KNOWN, **{n: v for n, v in known.items() if v is not NOTHING}, "__builtins__": {}}
    try:
        return eval(compile(ast.Expression(node), "<constant>", "eval"), scope)
    except Exception:
        return NOTHING
