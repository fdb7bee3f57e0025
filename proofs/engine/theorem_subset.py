"""The language of theorems, by permission: a claim can do what the engine offers, and no more.

A theorem's file has a docstring, imports of kernels, definitions, records and numbers, constants and
functions. Its functions compute with the values that the claim gives them, in loops over what is
written down; they see of the claim only its statements (`OFFERED`). What could be a value and change
behind the prover's back, an iterator that is kept or a list that another function extends, is not in
the list either.
"""

from __future__ import annotations

import ast
import builtins
import itertools
import math
import types
import typing
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

from cratous.core.kernel import Fold, entry_of
from cratous.core.kernel.sources import ours, place
from cratous.proofs.engine import definition_subset
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.kinds import is_record
from cratous.spec.errors import BadInput

OFFERED = frozenset(
    [
        "real",
        "reals",
        "integer",
        "whole",
        "boolean",
        "mask",
        "bits",
        "vector",
        "premise",
        "assume",
        "use",
        "define",
        "opaque",
        "calls",
        "congruence",
        "show",
        "step",
        "cases",
        "lemma",
        "implies",
        "all_of",
        "any_of",
        "negation",
        "when",
        "same",
        "fold",
    ]
)
"""What a claim has for a theorem."""
HIDDEN = (frozenset(vars(Claim)) | frozenset(Claim.__dataclass_fields__) | {"term"}) - OFFERED
TOOLS = (itertools.pairwise, itertools.combinations, itertools.product)
METHODS = frozenset(["append", "split", "join", "items", "keys", "values"])
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
STATEMENTS: tuple[type[ast.stmt], ...] = (
    ast.Assign, ast.AnnAssign, ast.For, ast.If, ast.Return, ast.FunctionDef, ast.Expr,
)  # fmt: skip
EXPRESSIONS: tuple[type[ast.expr], ...] = (
    ast.Name, ast.Attribute, ast.Call, ast.Constant, ast.Tuple, ast.List, ast.Dict, ast.BinOp,
    ast.UnaryOp, ast.Compare, ast.BoolOp, ast.IfExp, ast.Starred, ast.Subscript, ast.Slice,
    ast.ListComp, ast.DictComp, ast.GeneratorExp, ast.JoinedStr, ast.FormattedValue, ast.Lambda,
)  # fmt: skip
COMPARISONS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq, ast.In, ast.NotIn)
ITERATORS = frozenset(
    ["map", "zip", "enumerate", "reversed", "pairwise", "combinations", "product"]
)
MAKERS = (ast.List, ast.Dict, ast.ListComp, ast.DictComp)


class _Refused(Exception):
    def __init__(self, node: ast.AST, what: str, instead: str) -> None:
        super().__init__(what)
        self.line, self.what, self.instead = getattr(node, "lineno", 1), what, instead


def check(tree: ast.Module, path: Path) -> None:
    """Refuse a theorem's file that has what is not in the language; raises BadInput with the line."""
    try:
        modules = _top(tree)
        for function in tree.body:
            if isinstance(function, ast.FunctionDef):
                _Function(function, modules, nested=False).check()
    except _Refused as refused:
        raise BadInput(
            f"a theorem's file does not have {refused.what}",
            where=f"{place(path)}:{refused.line}",
            expected=refused.instead,
        ) from refused


def check_values(scope: dict[str, Any], tree: ast.Module, path: Path) -> None:
    """Refuse imports of anything but kernels, definitions, records, numbers and the engine's tools.

    A function of `spec` that the theorem calls itself, not by c.define, is held to what definitions have.
    """
    for node in ast.walk(tree):
        value = _called(node, scope)
        plain = isinstance(value, types.FunctionType) and not _of_theorems(value)
        if plain and (refused := definition_subset.outside(value)):
            raise BadInput(
                f"a theorem calls what is outside of the subset: {refused[0]}",
                where=f"{place(path)}:{getattr(node, 'lineno', 1)}",
                expected="definitions as docs/guides/own-kernel.md says",
            )
    for node in tree.body:
        if not isinstance(node, ast.ImportFrom) or node.module == "__future__":
            continue
        for alias in node.names:
            value = scope[alias.asname or alias.name]
            if not _may_be_imported(value, str(node.module)):
                raise BadInput(
                    f"a theorem's file does not import {alias.name!r} of {node.module}",
                    where=f"{place(path)}:{node.lineno}",
                    expected="kernels as they are registered, folds, functions and modules of `spec`, "
                    "records, numbers",
                )


def _may_be_imported(value: Any, module: str) -> bool:
    if module in ("typing", "collections.abc", "itertools", "fractions"):
        return module != "itertools" or value in TOOLS
    if module == "math":
        return value is math.sqrt
    if value is Claim or value is Fold or entry_of(value) is not None or is_record(value):
        return True
    if isinstance(value, bool | int | float | Fraction | str):
        return True
    if isinstance(value, types.ModuleType):
        inside = value.__name__.split(".")[1:2]
        mine = ours(_Named(value.__name__)) and inside not in (["proofs"], ["services"])
        return mine and (not value.__name__.startswith("cratous.core") or inside == ["spec"])
    if isinstance(value, dict | tuple | frozenset | list):
        parts = value.items() if isinstance(value, dict) else value
        return all(_may_be_imported(part, module) for part in parts)
    if isinstance(value, types.FunctionType) and ours(value):
        return _of_theorems(value) or value.__module__.split(".")[1:2] == ["spec"]
    return typing.get_origin(value) is not None


def _of_theorems(function: types.FunctionType) -> bool:
    """A function of a theorem's file, or a method of proof of the product."""
    home = function.__module__.partition(".")[2]
    product = function.__module__.startswith("cratous.")
    return home.startswith("theorems.") or (
        product and home.startswith(("proofs.methods", "proofs.theorems"))
    )


def _called(node: ast.AST, scope: dict[str, Any]) -> Any:
    """What a call calls, if it is a global name or the attribute of a module; else None."""
    if not isinstance(node, ast.Call):
        return None
    if isinstance(node.func, ast.Name):
        return scope.get(node.func.id)
    if isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Name):
        owner = scope.get(node.func.value.id)
        if isinstance(owner, types.ModuleType):
            return vars(owner).get(node.func.attr)
    return None


class _Named:
    """Stands for a module where `ours` wants something that has one."""

    def __init__(self, module: str) -> None:
        self.__module__ = module


def _top(tree: ast.Module) -> set[str]:
    """Check what stands at the top of the file; returns the imported names."""
    names: set[str] = set()
    for number, node in enumerate(tree.body):
        if isinstance(node, ast.ImportFrom):
            module = node.module or ""
            if node.level or any(alias.name == "*" for alias in node.names):
                raise _Refused(node, "such an import", "from package.module import names")
            inside = module.split(".")[1:2]
            if inside == ["proofs"] and not _of_proofs(module):
                raise _Refused(
                    node, f"an import from {module}", "from cratous.proofs.claim import Claim"
                )
            names |= {alias.asname or alias.name for alias in node.names}
        elif isinstance(node, ast.Assign):
            _Function(None, names, nested=False).expression(node.value)
            if not all(isinstance(target, ast.Name) for target in node.targets):
                raise _Refused(node, "such an assignment", "a constant with a name")
        elif not isinstance(node, ast.FunctionDef) and not (number == 0 and _is_text(node)):
            raise _Refused(node, f"a {type(node).__name__}", "imports, constants and functions")
    return names


def _of_proofs(module: str) -> bool:
    return module == "cratous.proofs.claim" or module.startswith(
        ("cratous.proofs.methods", "cratous.proofs.theorems")
    )


def _is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


class _Function:
    """Checks one function of a theorem's file."""

    def __init__(self, node: ast.FunctionDef | None, imported: set[str], *, nested: bool) -> None:
        self.node, self.imported, self.nested = node, imported, nested
        # what an inner function is given or finds, another call of it would see changed
        self.made = {
            name.id
            for part in ([] if node is None else _own(node.body))
            for name in _targets(part, made_here=nested)
        }

    def check(self) -> None:
        assert self.node is not None
        if self.node.decorator_list:
            raise _Refused(self.node, "a decorator", "a plain function")
        for default in (*self.node.args.defaults, *self.node.args.kw_defaults):
            if default is not None:
                self.expression(default)
        self._block(self.node.body)

    def _block(self, body: list[ast.stmt]) -> None:
        for node in body:
            if not isinstance(node, STATEMENTS):
                raise _Refused(node, f"a {type(node).__name__}", "assignments, loops and calls")
            self._statement(node)

    def _statement(self, node: ast.stmt) -> None:
        match node:
            case ast.FunctionDef():
                _Function(node, self.imported, nested=True).check()
            case ast.Assign():
                for target in node.targets:
                    self._target(target)
                self._kept(node.value, node.targets)
            case ast.AnnAssign():
                self._target(node.target)
                if node.value is not None:
                    self._kept(node.value, [node.target])
            case ast.For():
                self._target(node.target)
                self.expression(node.iter, consumed=True)
                self._block([*node.body, *node.orelse])
            case ast.If():
                self.expression(node.test)
                self._block([*node.body, *node.orelse])
            case ast.Return():
                if node.value is not None:
                    self._kept(node.value, [])
            case ast.Expr():
                self.expression(node.value)

    def _target(self, node: ast.expr) -> None:
        if isinstance(node, ast.Subscript):
            if not (isinstance(node.value, ast.Name) and node.value.id in self.made):
                raise _Refused(
                    node, "a change of what is made elsewhere", "a list of this function"
                )
            self.expression(node.slice)
            return
        for part in ast.walk(node):
            if isinstance(part, ast.Attribute):
                self._attribute(part)
                raise _Refused(
                    part, f"a change of {part.attr!r}", "names are assigned, nothing else"
                )
        parts = [n for n in ast.walk(node) if isinstance(n, ast.expr)]
        if not all(
            isinstance(part, ast.Name | ast.Tuple | ast.Starred | ast.List) for part in parts
        ):
            raise _Refused(node, "such an assignment", "names")

    def _kept(self, value: ast.expr, targets: list[ast.expr]) -> None:
        """A value that gets a name: no iterator, which a second look would find at its end."""
        apart = bool(targets) and all(isinstance(t, ast.Tuple | ast.List) for t in targets)
        self.expression(value, consumed=apart)

    def expression(self, node: ast.expr, *, consumed: bool = False) -> None:
        """Check an expression; consumed: it is gone through at once, so it may be an iterator."""
        if not isinstance(node, EXPRESSIONS):
            raise _Refused(node, f"a {type(node).__name__}", "numbers, records, lists and calls")
        called = node.func if isinstance(node, ast.Call) else None
        iterator = isinstance(node, ast.GeneratorExp) or (
            isinstance(called, ast.Name) and called.id in ITERATORS
        )
        if iterator and not consumed:
            raise _Refused(node, "an iterator that is kept", "a list: [... for ... in ...]")
        if isinstance(node, ast.Attribute):
            self._attribute(node)
        python = isinstance(node, ast.Name) and hasattr(builtins, node.id)
        if isinstance(node, ast.Name) and python and node.id not in BUILTINS | self.imported:
            raise _Refused(node, f"{node.id!r} of Python", "the claim's statements")
        if isinstance(node, ast.Compare) and not all(isinstance(o, COMPARISONS) for o in node.ops):
            raise _Refused(node, "`is`", "==, or c.same of two values")
        at_once = isinstance(node, ast.Call | ast.Starred)
        for part in _parts(node):
            self.expression(part, consumed=at_once or isinstance(part, ast.Starred))
        if isinstance(called, ast.Attribute):
            self._method(called)
        if isinstance(node, ast.ListComp | ast.DictComp | ast.GeneratorExp):
            for one in node.generators:
                self._target(one.target)
                self.expression(one.iter, consumed=True)

    def _attribute(self, node: ast.Attribute) -> None:
        of_module = isinstance(node.value, ast.Name) and node.value.id in self.imported
        hidden = node.attr in HIDDEN and not of_module
        if hidden or (node.attr.startswith("_") and node.attr != "__name__"):
            raise _Refused(
                node, f"{node.attr!r} of the claim", "its statements: c.show, c.premise, ..."
            )
        if node.attr == "calls" and self.nested:
            raise _Refused(node, "c.calls in an inner function", "c.calls in `claim`")

    def _method(self, called: ast.Attribute) -> None:
        owner = called.value.id if isinstance(called.value, ast.Name) else ""
        if called.attr == "append" and owner not in self.made:
            raise _Refused(called, "a change of what is made elsewhere", "a list of this function")
        if called.attr not in OFFERED | METHODS and owner not in self.imported:
            raise _Refused(called, f"a call of {called.attr!r}", "the claim's statements")


def _parts(node: ast.expr) -> Iterator[ast.expr]:
    """The expressions in an expression, those of a comprehension's loops apart."""
    for part in ast.iter_child_nodes(node):
        if isinstance(part, ast.expr):
            yield part
        elif isinstance(part, ast.keyword):
            yield part.value
        elif isinstance(part, ast.comprehension):
            yield from part.ifs
        elif isinstance(part, ast.arguments):
            yield from [d for d in (*part.defaults, *part.kw_defaults) if d is not None]


def _targets(node: ast.stmt, *, made_here: bool) -> Iterator[ast.Name]:
    """The names that a statement assigns; made_here: only to what it makes itself."""
    if isinstance(node, ast.For) and not made_here:
        targets: list[ast.expr] = [node.target]
    elif isinstance(node, ast.Assign | ast.AnnAssign):
        if made_here and not isinstance(node.value, MAKERS):
            return
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    else:
        return
    for target in targets:
        yield from (n for n in ast.walk(target) if isinstance(n, ast.Name) and _is_stored(n))


def _is_stored(name: ast.Name) -> bool:
    return isinstance(name.ctx, ast.Store)


def _own(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """The statements of a function, those of functions in it apart."""
    for node in body:
        yield node
        if not isinstance(node, ast.FunctionDef):
            yield from _own([n for n in ast.iter_child_nodes(node) if isinstance(n, ast.stmt)])
