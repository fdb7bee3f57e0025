"""The names in a theorem's file: what binds them, and what a function may change.

Each reading of a claim must state the same, so nothing that a reading changes may outlive it.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from collections.abc import Set as AbstractSet
from fractions import Fraction

BUILTINS = frozenset(
    [
        "zip",
        "list",
        "dict",
        "object",
        "tuple",
        "float",
        "str",
        "map",
        "abs",
        "enumerate",
        "len",
        "range",
        "min",
        "max",
        "int",
        "bool",
        "sorted",
        "reversed",
        "sum",
        "True",
        "False",
        "None",
    ]
)
ITERATORS = frozenset(
    ["map", "zip", "enumerate", "reversed", "pairwise", "combinations", "product"]
)
MAKERS = (ast.List, ast.Dict, ast.ListComp, ast.DictComp)
CONSUMERS = frozenset(["list", "tuple", "dict", "sorted", "sum", "min", "max", "join", *ITERATORS])
"""Calls that use an iterator up, or wrap it in one that is."""
BEHAVIOUR = frozenset(
    name
    for kind in (list, dict, str, tuple, int, Fraction, range)
    for name in dir(kind)
    if callable(getattr(kind, name))
)
"""The methods of Python's own values: one that is not called where it is named could change a value unseen."""
FIELDS = frozenset(["items", "clear"])
"""Methods of lists and dictionaries that are fields of records too."""


class Refused(Exception):
    """A part of a theorem's file that is outside of its language, with what to write instead."""

    def __init__(self, node: ast.AST, what: str, instead: str) -> None:
        super().__init__(what)
        self.line, self.what, self.instead = getattr(node, "lineno", 1), what, instead


def rebound(tree: ast.Module) -> set[str]:
    """The names that a file binds other than by imports.

    Raises Refused for names of Python's own functions, and for a call without arguments of a name that is not one
    function or import: it could be a method that changes a list (`FIELDS`).
    """
    found: dict[str, list[ast.AST]] = {}
    for node in ast.walk(tree):
        name = _bound_name(node)
        if name in BUILTINS | CONSUMERS:
            raise Refused(node, f"another {name!r} than Python's own", "a name of its own")
        if name.startswith("__"):  # `__builtins__` would exchange them all
            raise Refused(node, f"a value for {name!r}", "a name of its own")
        if name:
            found.setdefault(name, []).append(node)
    for node in ast.walk(tree):
        called = node.func if isinstance(node, ast.Call) and not node.args else None
        by = found.get(called.id, []) if isinstance(called, ast.Name) else []
        if not all(isinstance(one, ast.FunctionDef | ast.alias) for one in by):
            raise Refused(node, "a call of a value without arguments", "a call of a function")
    return {name for name, by in found.items() if not all(isinstance(b, ast.alias) for b in by)}


def _bound_name(node: ast.AST) -> str:
    """The name that a node binds; empty for none, and for a tool of `itertools` by its own name."""
    if isinstance(node, ast.FunctionDef):
        return node.name
    if isinstance(node, ast.arg):
        return node.arg
    if isinstance(node, ast.alias):
        return node.asname or ("" if node.name in ITERATORS else node.name)
    return node.id if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) else ""


def made_in(function: ast.FunctionDef) -> set[str]:
    """The names of a function that are bound to lists and dictionaries made there, and to nothing else."""
    values: dict[str, list[ast.expr | None]] = {}
    outside = {_bound_name(n) for n in ast.walk(function) if isinstance(n, ast.arg)}
    for node in ast.walk(function):
        if isinstance(node, ast.comprehension):
            outside |= set(_stored(node.target))
    for part in _own(function.body):
        if isinstance(part, ast.FunctionDef):
            outside.add(part.name)
        for target, value in _assigned(part):
            for name, given in _paired(target, value):
                values.setdefault(name, []).append(given)
    made = values.keys() - outside
    while True:  # another name of what is made here is one of these too
        kept = {name for name in made if all(_makes(value, made) for value in values[name])}
        if kept == made:
            return kept
        made = kept


def _assigned(part: ast.stmt) -> Iterator[tuple[ast.expr, ast.expr | None]]:
    """The targets of a statement, each with its value; of a loop over written values, with each of them."""
    match part:
        case ast.Assign(targets=targets, value=value):
            yield from ((target, value) for target in targets)
        case ast.AnnAssign(target=target, value=value) if value is not None:
            yield target, value
        case ast.For(target=target, iter=ast.Tuple(elts=each) | ast.List(elts=each)):
            yield from ((target, value) for value in each)
        case ast.For(target=target):
            yield target, None


def _paired(target: ast.expr, value: ast.expr | None) -> Iterator[tuple[str, ast.expr | None]]:
    """The names of a target, each with the value written for it; None for a part of another value."""
    if isinstance(target, ast.Name):
        yield target.id, value
    elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and _alike(target, value):
        for one, given in zip(target.elts, value.elts, strict=True):
            yield from _paired(one, given)
    else:
        yield from ((name, None) for name in _stored(target))


def _alike(target: ast.Tuple, value: ast.Tuple) -> bool:
    starred = any(isinstance(part, ast.Starred) for part in (*target.elts, *value.elts))
    return len(target.elts) == len(value.elts) and not starred


def _makes(value: ast.expr | None, made: AbstractSet[str]) -> bool:
    """Whether a value is a list or dictionary made here, or one of these names for such."""
    return _new(value) or (isinstance(value, ast.Name) and value.id in made)


def _new(value: ast.expr | None) -> bool:
    called = value.func if isinstance(value, ast.Call) else None
    by_name = isinstance(called, ast.Name) and called.id in ("list", "dict")
    return isinstance(value, MAKERS) or by_name


def _stored(target: ast.expr) -> list[str]:
    """The names that an assignment to this target binds."""
    return [name for node in ast.walk(target) if (name := _bound_name(node))]


def _own(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements of a function, without those of nested functions."""
    for node in body:
        yield node
        if not isinstance(node, ast.FunctionDef):
            yield from _own([n for n in ast.iter_child_nodes(node) if isinstance(n, ast.stmt)])
