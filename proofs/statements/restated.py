"""Whether a definition has its kernel's own formula, in which case a proof of their equality says little.

Both bodies are brought to a normal form: names by position, a named value substituted where it is used, branches as
one conditional, operands of commutative operators in a fixed order, fields of records by number, constants by value,
and calls replaced by what is called.
"""

from __future__ import annotations

import ast
import functools
import inspect
import types
from collections.abc import Callable
from typing import Any, cast, get_type_hints

from cratous.core.kernel.sources import text_of

Form = tuple[Any, ...]
"""A node: its kind, followed by its parts."""

COMMUTE = {"Add", "Mult", "And", "Or", "Eq", "NotEq", "BitAnd", "BitOr", "BitXor", "min", "max"}
NESTED = {"Add", "Mult", "And", "Or", "min", "max"}
"""Operators that are also associative: a + (b + c)."""
TURNED = {"Gt": "Lt", "GtE": "LtE"}
CONSTANTS = (bool, int, float, str)


DEPTH = 4
"""The depth to which nested calls are followed; beyond it the body counts as a computation, not a formula."""


class NoForm(Exception):
    """The body has statements that this comparison does not support."""


def restates(kernel: Callable[..., Any], definition: Callable[..., Any]) -> bool | None:
    """True iff both have the same formula; None where one of them is not a formula."""
    try:
        return form(kernel) == form(definition)
    except (NoForm, OSError, TypeError):
        return None


def form(function: Callable[..., Any]) -> Form:
    """The normal form of a function's body. Raises NoForm for loops and other statements."""
    hints = get_type_hints(function)
    names = inspect.signature(function).parameters
    arguments = [_argument(("argument", i), hints.get(name)) for i, name in enumerate(names)]
    return _called(function, arguments, ())


def _called(function: Callable[..., Any], arguments: list[Form], circle: tuple[Any, ...]) -> Form:
    """The form of a function's result for these arguments."""
    if function in circle or len(circle) > DEPTH:
        raise NoForm
    node = _definition(function)
    if len(node.args.args) != len(arguments):
        raise NoForm
    scope = {arg.arg: value for arg, value in zip(node.args.args, arguments, strict=True)}
    return _Reader(function, (*circle, function)).block(node.body, scope)


@functools.cache
def _definition(function: Callable[..., Any]) -> ast.FunctionDef:
    node = ast.parse(text_of(function)).body[0]
    assert isinstance(node, ast.FunctionDef)
    return node


class _Record(tuple[Any, ...]):
    """The form of a record: equal to a record with other field names and the same fields."""

    names: tuple[str, ...]


def _record(parts: list[Form], names: tuple[str, ...] = ()) -> _Record:
    made = _Record(("record", *parts))
    made.names = names
    return made


def _argument(at: Form, kind: Any) -> Form:
    """The form of an argument; a record is the tuple of its fields."""
    names = getattr(kind, "_fields", None)
    if names is None:
        return at
    kinds = get_type_hints(kind)
    return _record([_argument((*at, i), kinds.get(name)) for i, name in enumerate(names)], names)


class _Reader:
    """Reads the body of one function."""

    def __init__(self, function: Any, circle: tuple[Any, ...]) -> None:
        self.globals, self.circle = function.__globals__, circle

    def block(self, body: list[ast.stmt], scope: dict[str, Form]) -> Form:
        """The form of the result of these statements."""
        if not body:
            raise NoForm
        first, rest = body[0], body[1:]
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
            return self.block(rest, scope)
        if isinstance(first, ast.Return) and first.value is not None:
            return self.value(first.value, scope)
        if isinstance(first, ast.Assign) and len(first.targets) == 1:
            return self.block(rest, scope | self.named(first.targets[0], first.value, scope))
        if isinstance(first, ast.If):
            condition = self.value(first.test, scope)
            return _either(
                condition,
                self.block([*first.body, *rest], dict(scope)),
                self.block([*first.orelse, *rest], dict(scope)),
            )
        raise NoForm

    def named(self, target: ast.expr, value: ast.expr, scope: dict[str, Form]) -> dict[str, Form]:
        """The forms of the names that an assignment binds."""
        made = self.value(value, scope)
        if isinstance(target, ast.Name):
            return {target.id: made}
        if isinstance(target, ast.Tuple) and all(isinstance(t, ast.Name) for t in target.elts):
            parts = [
                made[1 + i] if isinstance(made, _Record) else ("part", made, i)
                for i in range(len(target.elts))
            ]
            return {
                t.id: part
                for t, part in zip(target.elts, parts, strict=True)
                if isinstance(t, ast.Name)
            }
        raise NoForm

    def value(self, node: ast.expr, scope: dict[str, Form]) -> Form:
        """The form of an expression."""
        match node:
            case ast.Constant(value=known):
                return ("constant", repr(known))
            case ast.Name(id=name):
                return scope[name] if name in scope else self.constant(self.globals.get(name))
            case ast.Attribute(value=ast.Name(id=name), attr=attr) if name not in scope:
                return self.constant(getattr(self.globals.get(name), attr, None))
            case ast.Attribute(value=inner, attr=attr):
                return self.attribute(self.value(inner, scope), attr)
            case ast.UnaryOp(op=ast.USub(), operand=one):
                return _joined("Sub", [("constant", "0"), self.value(one, scope)])
            case ast.UnaryOp(op=op, operand=one):
                return (
                    _negated(self.value(one, scope)) if isinstance(op, ast.Not) else self.refuse()
                )
            case ast.BinOp(left=a, op=op, right=b):
                return _joined(type(op).__name__, [self.value(a, scope), self.value(b, scope)])
            case ast.BoolOp(op=op, values=parts):
                return _joined(type(op).__name__, [self.value(p, scope) for p in parts])
            case ast.Compare(left=left, ops=ops, comparators=others):
                sides = [self.value(side, scope) for side in (left, *others)]
                pairs = zip(ops, sides, sides[1:], strict=False)
                found = [_compared(type(op).__name__, a, b) for op, a, b in pairs]
                return found[0] if len(found) == 1 else _joined("And", found)
            case ast.IfExp(test=test, body=yes, orelse=no):
                return _either(*[self.value(part, scope) for part in (test, yes, no)])
            case ast.Tuple(elts=parts):
                return _record([self.value(part, scope) for part in parts])
            case ast.Call(func=called, args=args, keywords=[]):
                return self.call(called, [self.value(arg, scope) for arg in args])
        return self.refuse()

    def attribute(self, inner: Form, attr: str) -> Form:
        """A field of a record."""
        if isinstance(inner, _Record) and attr in inner.names:
            return cast(Form, inner[1 + inner.names.index(attr)])
        return ("field", inner, attr)

    def call(self, called: ast.expr, args: list[Form]) -> Form:
        """The form of a call: for a record class its fields, for a function its body's form."""
        target: Any = None
        if isinstance(called, ast.Name):
            target = self.globals.get(called.id, called.id)
        elif isinstance(called, ast.Attribute) and isinstance(called.value, ast.Name):
            target = getattr(self.globals.get(called.value.id), called.attr, None)
        if hasattr(target, "_fields"):
            return _record(args, target._fields)
        if isinstance(target, types.FunctionType):
            return _called(target, args, self.circle)
        if isinstance(target, str):
            return _joined(target, args)
        return self.refuse()

    def constant(self, known: Any) -> Form:
        """The form of a constant from outside the function."""
        return ("constant", repr(known)) if isinstance(known, CONSTANTS) else self.refuse()

    def refuse(self) -> Form:
        """Raise NoForm for anything that is not compared."""
        raise NoForm


TRUE, FALSE = ("constant", "True"), ("constant", "False")


def _joined(kind: str, parts: list[Form]) -> Form:
    if kind in NESTED:
        parts = [inner for p in parts for inner in (p[1:] if p[0] == kind else [p])]
    return (kind, *(sorted(parts, key=repr) if kind in COMMUTE else parts))


def _compared(kind: str, a: Form, b: Form) -> Form:
    return _joined(TURNED[kind], [b, a]) if kind in TURNED else _joined(kind, [a, b])


def _negated(part: Form) -> Form:
    opposite = {"Eq": "NotEq", "NotEq": "Eq"}
    if part[0] in opposite:
        return (opposite[part[0]], *part[1:])
    if part[0] in ("Lt", "LtE"):
        return ("LtE" if part[0] == "Lt" else "Lt", part[2], part[1])
    if part[0] in ("And", "Or"):
        return _joined("Or" if part[0] == "And" else "And", [_negated(p) for p in part[1:]])
    return part[1] if part[0] == "Not" else ("Not", part)


def _either(condition: Form, yes: Form, no: Form) -> Form:
    """The form of a conditional; for truth values, as and/or/not."""
    if yes == TRUE:
        return condition if no == FALSE else _joined("Or", [condition, no])
    if yes == FALSE:
        return _negated(condition) if no == TRUE else _joined("And", [_negated(condition), no])
    if no == FALSE:
        return _joined("And", [condition, yes])
    if no == TRUE:
        return _joined("Or", [_negated(condition), yes])
    if isinstance(yes, _Record) and isinstance(no, _Record) and len(yes) == len(no):
        pairs = zip(yes[1:], no[1:], strict=True)
        return _record([a if a == b else _either(condition, a, b) for a, b in pairs], yes.names)
    negative = _negated(condition)
    return (
        ("If", condition, yes, no)
        if repr(condition) <= repr(negative)
        else ("If", negative, no, yes)
    )
