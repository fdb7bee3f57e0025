"""The language of theorems: a claim can use what the engine offers, and nothing else.

A theorem's file has a docstring, imports of kernels, definitions, records and numbers, constants and functions. Its
functions compute with the values that the claim gives them, in loops over written values; of the claim they see only
its statements (`OFFERED`). Each reading of a claim must state the same, so nothing may outlive one: constants and
defaults are no lists, a list is changed only by the function that made it, iterators are consumed where they are made
and their makers have no other name, and methods are called where they are named.
"""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator
from pathlib import Path

from cratous.core.kernel.sources import place
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.theorem_names import (
    BEHAVIOUR,
    BUILTINS,
    CONSUMERS,
    FIELDS,
    ITERATORS,
    Refused,
    made_in,
    rebound,
)
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
"""The statements of a claim that a theorem may use."""
HIDDEN = (frozenset(vars(Claim)) | frozenset(Claim.__dataclass_fields__) | {"term"}) - OFFERED
METHODS = frozenset(["append", "split", "join", "items", "keys", "values"])
STATEMENTS: tuple[type[ast.stmt], ...] = (
    ast.Assign, ast.AnnAssign, ast.For, ast.If, ast.Return, ast.FunctionDef, ast.Expr,
)  # fmt: skip
EXPRESSIONS: tuple[type[ast.expr], ...] = (
    ast.Name, ast.Attribute, ast.Call, ast.Constant, ast.Tuple, ast.List, ast.Dict, ast.BinOp,
    ast.UnaryOp, ast.Compare, ast.BoolOp, ast.IfExp, ast.Starred, ast.Subscript, ast.Slice,
    ast.ListComp, ast.DictComp, ast.GeneratorExp, ast.JoinedStr, ast.FormattedValue, ast.Lambda,
)  # fmt: skip
TYPES = (ast.Name, ast.Attribute, ast.Subscript, ast.Tuple, ast.List, ast.BinOp, ast.Constant)
COMPARISONS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq, ast.In, ast.NotIn)
WORDS: dict[type[ast.AST], str] = {
    ast.Import: "`import` of a whole module",
    ast.ClassDef: "a class",
    ast.AsyncFunctionDef: "`async`",
    ast.AugAssign: "`+=` and its like",
    ast.NamedExpr: "`:=`",
    ast.Set: "a set",
    ast.SetComp: "a set",
}


def check(tree: ast.Module, path: Path) -> None:
    """Raise BadInput, with the line, for a theorem's file that is outside of the language."""
    try:
        modules = _top(tree) - rebound(tree)
        for function in tree.body:
            if isinstance(function, ast.FunctionDef):
                _Function(function, modules, nested=False).check()
    except Refused as refused:
        raise BadInput(
            f"a theorem's file does not have {refused.what}",
            where=f"{place(path)}:{refused.line}",
            expected=refused.instead,
        ) from refused


def _top(tree: ast.Module) -> set[str]:
    """Check the top level of the file; returns the imported names."""
    names: set[str] = set()
    for number, node in enumerate(tree.body):
        if isinstance(node, ast.ImportFrom):
            module = node.module or ""
            if node.level or any(alias.name == "*" for alias in node.names):
                raise Refused(node, "such an import", "from package.module import names")
            inside = module.split(".")[1:2]
            if inside == ["proofs"] and not _of_proofs(module):
                raise Refused(
                    node, f"an import from {module}", "from cratous.proofs.claim import Claim"
                )
            renamed = [a.asname for a in node.names if a.name in ITERATORS and a.asname]
            if renamed and module == "itertools":
                raise Refused(node, f"{renamed[0]!r} for a maker of iterators", "its own name")
            names |= {alias.asname or alias.name for alias in node.names}
        elif isinstance(node, ast.Assign):
            _Function(None, names, nested=False).expression(node.value)
            if not all(isinstance(target, ast.Name) for target in node.targets):
                raise Refused(node, "such an assignment", "a constant with a name")
        elif not isinstance(node, ast.FunctionDef) and not (number == 0 and _is_text(node)):
            raise Refused(node, _named(node), "imports from modules, constants and functions")
    return names


def _named(node: ast.AST) -> str:
    """A kind of syntax as it is called in messages."""
    return WORDS.get(type(node), f"`{type(node).__name__.lower()}`")


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
        # what a function receives, or takes from elsewhere by another name, outlives it: the next call would see a
        # change
        self.made: set[str] = set() if node is None else made_in(node)

    def check(self) -> None:
        assert self.node is not None
        if self.node.decorator_list:
            raise Refused(self.node, "a decorator", "a plain function")
        for default in (*self.node.args.defaults, *self.node.args.kw_defaults):
            if default is not None:
                self.expression(default)
        given = self.node.args
        every = (*given.posonlyargs, *given.args, *given.kwonlyargs, given.vararg, given.kwarg)
        for annotation in (self.node.returns, *(one.annotation for one in every if one)):
            if annotation is not None:
                self._type(annotation)
        self._block(self.node.body)

    def _type(self, node: ast.expr) -> None:
        """Check an annotation, which Python evaluates when the file is read: names of types only."""
        for part in ast.walk(node):
            text = isinstance(part, ast.Constant) and part.value is not None and part.value != ...
            if isinstance(part, ast.expr) and (text or not isinstance(part, TYPES)):
                raise Refused(node, "an annotation that is computed", "the name of a type")
            if isinstance(part, ast.Name | ast.Attribute):
                self.expression(part)

    def _block(self, body: list[ast.stmt]) -> None:
        for node in body:
            if not isinstance(node, STATEMENTS):
                raise Refused(node, _named(node), "assignments, loops and calls")
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
                raise Refused(node, "a change of what is made elsewhere", "a list of this function")
            self.expression(node.slice)
            return
        for part in ast.walk(node):
            if isinstance(part, ast.Attribute):
                self._attribute(part)
                raise Refused(
                    part, f"a change of {part.attr!r}", "names are assigned, nothing else"
                )
        parts = [n for n in ast.walk(node) if isinstance(n, ast.expr)]
        if not all(
            isinstance(part, ast.Name | ast.Tuple | ast.Starred | ast.List) for part in parts
        ):
            raise Refused(node, "such an assignment", "names")

    def _kept(self, value: ast.expr, targets: list[ast.expr]) -> None:
        """Check a value that is assigned or returned: no iterator, which would be exhausted when used again."""
        apart = bool(targets) and all(isinstance(t, ast.Tuple | ast.List) for t in targets)
        self.expression(value, consumed=apart)

    def expression(
        self, node: ast.expr, *, consumed: bool = False, being_called: bool = False
    ) -> None:
        """Check an expression; consumed: it is consumed at once, so it may be an iterator; being_called: it is what
        is called."""
        if not isinstance(node, EXPRESSIONS):
            raise Refused(node, _named(node), "numbers, records, lists and calls")
        called = node.func if isinstance(node, ast.Call) else None
        iterator = isinstance(node, ast.GeneratorExp) or (
            isinstance(called, ast.Name) and called.id in ITERATORS
        )
        if iterator and not consumed:
            raise Refused(node, "an iterator that is kept", "a list: [... for ... in ...]")
        if isinstance(node, ast.Attribute):
            self._attribute(node, being_called)
        python = isinstance(node, ast.Name) and hasattr(builtins, node.id)
        inner = isinstance(node, ast.Name) and node.id.startswith("__")
        if isinstance(node, ast.Name) and (
            inner or (python and node.id not in BUILTINS | self.imported)
        ):
            raise Refused(node, f"{node.id!r} of Python", "the claim's statements")
        if called is not None and not isinstance(called, ast.Name | ast.Attribute):
            raise Refused(node, "a call of what has no name", "name it first")
        if isinstance(node, ast.Name) and node.id in ITERATORS and not being_called:
            raise Refused(node, f"{node.id!r} by another name", f"a call: {node.id}(...)")
        if isinstance(node, ast.Compare) and not all(isinstance(o, COMPARISONS) for o in node.ops):
            raise Refused(node, "`is`", "==, or c.same of two values")
        if isinstance(node, ast.Lambda):
            for default in (*node.args.defaults, *node.args.kw_defaults):
                if default is not None:
                    self.expression(default)
            _Function(None, self.imported, nested=True).expression(node.body)
            return
        at_once = isinstance(node, ast.Starred) or _last(called) in CONSUMERS
        for part in _parts(node):
            starred = isinstance(part, ast.Starred)
            self.expression(part, consumed=at_once or starred, being_called=part is called)
        if isinstance(called, ast.Attribute):
            self._method(called)
        if isinstance(node, ast.ListComp | ast.DictComp | ast.GeneratorExp):
            for one in node.generators:
                self._target(one.target)
                self.expression(one.iter, consumed=True)

    def _attribute(self, node: ast.Attribute, being_called: bool = False) -> None:
        of_module = isinstance(node.value, ast.Name) and node.value.id in self.imported
        hidden = node.attr in HIDDEN and not of_module
        if hidden or (node.attr.startswith("_") and node.attr != "__name__"):
            raise Refused(
                node, f"{node.attr!r} of the claim", "its statements: c.show, c.premise, ..."
            )
        if node.attr in BEHAVIOUR - FIELDS and not of_module and not being_called:
            raise Refused(node, f"{node.attr!r} without a call", "a call where it is named")
        # another call of it would find more calls
        if node.attr == "calls" and self.nested:
            raise Refused(node, "c.calls in an inner function", "c.calls in `claim`")

    def _method(self, called: ast.Attribute) -> None:
        owner = called.value.id if isinstance(called.value, ast.Name) else ""
        if called.attr == "append" and owner not in self.made:
            raise Refused(called, "a change of what is made elsewhere", "a list of this function")
        if called.attr not in OFFERED | METHODS and owner not in self.imported:
            raise Refused(called, f"a call of {called.attr!r}", "the claim's statements")


def _last(called: ast.expr | None) -> str:
    """The last part of the name that is called; empty for none."""
    if isinstance(called, ast.Attribute):
        return called.attr
    return called.id if isinstance(called, ast.Name) else ""


def _parts(node: ast.expr) -> Iterator[ast.expr]:
    """The subexpressions of an expression, without those that a comprehension iterates over."""
    for part in ast.iter_child_nodes(node):
        if isinstance(part, ast.expr):
            yield part
        elif isinstance(part, ast.keyword):
            yield part.value
        elif isinstance(part, ast.comprehension):
            yield from part.ifs
