"""The expressions of the kernel subset and the kind that each has (see `subset`)."""

from __future__ import annotations

import ast
import builtins
import inspect
from typing import Any, get_type_hints

from cratous.core.kernel import entry_of
from cratous.core.kernel.sources import is_root
from cratous.proofs.engine.value_kinds import INT64, Kind, Literal, fits, is_record, merged, shown

INSTEAD: dict[type[ast.AST], str] = {
    ast.Lambda: "name a kernel instead of a lambda",
    ast.ListComp: "no collections in kernels; use a `fold`",
    ast.GeneratorExp: "no collections in kernels; use a `fold`",
    ast.DictComp: "no collections in kernels; use a `fold`",
    ast.SetComp: "no collections in kernels; use a `fold`",
    ast.List: "no collections in kernels; use a `fold`",
    ast.Dict: "no collections in kernels; use a `fold`",
    ast.Set: "no collections in kernels; use a `fold`",
    ast.Subscript: "no indexing in kernels; pass the item (see `fold`)",
    ast.JoinedStr: "no text in kernels",
    ast.IfExp: "write `if` as a statement: the lifter forks there",
    ast.NamedExpr: "assign first, then use",
    ast.Tuple: "no bare tuples: make a record, or assign one name at a time",
    ast.Starred: "write the arguments out",
}
OPERATORS: dict[type[ast.operator], str] = {
    ast.FloorDiv: "// differs between the readings; multiply out instead",
    ast.Mod: "% differs between the readings; multiply out instead",
    ast.Pow: "** differs between the readings; write the product",
    ast.LShift: "no shifts in kernels: pass the mask",
    ast.RShift: "no shifts in kernels: pass the mask",
    ast.BitXor: "masks have & and |",
    ast.MatMult: "numbers have + - * /",
}
ORDER = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
NUMBERS = (float, int)
OWN = {"abs": abs, "min": min, "max": max}
"""Python's built-in functions that every reading implements, by name."""


class Refused(Exception):
    """An expression or statement that is outside of the subset."""

    def __init__(self, node: ast.AST, message: str) -> None:
        super().__init__(message)
        self.node, self.message = node, message


class Kinds:
    """Determines the kind of an expression, or raises Refused.

    several: whether several names may be assigned at once.
    """

    several = False

    def __init__(self, scope: dict[str, Any], local: set[str]) -> None:
        self.scope, self.local = scope, local

    def of(self, node: ast.expr, names: dict[str, Kind]) -> Kind:
        """The kind of an expression, given the kinds of the locals."""
        match node:
            case ast.Constant():
                return _constant(node)
            case ast.Name():
                return self._name(node, names)
            case ast.UnaryOp():
                return self._unary(node, names)
            case ast.BinOp():
                return self._binary(node, names)
            case ast.BoolOp():
                for part in node.values:
                    self.truth(part, names)
                return bool
            case ast.Compare():
                return self._compare(node, names)
            case ast.Attribute():
                return self._field(node, names)
            case ast.Call():
                return self._call(node, names)
        what = type(node).__name__
        raise Refused(node, INSTEAD.get(type(node), f"no {what} in kernels and definitions"))

    def truth(self, node: ast.expr, names: dict[str, Kind]) -> None:
        """Check a condition: it must be a truth value, not merely something Python accepts as one."""
        kind = self.of(node, names)
        if kind is not bool:
            raise Refused(node, f"a condition is a truth value, this is {shown(kind)}: compare it")

    def _name(self, node: ast.Name, names: dict[str, Kind]) -> Kind:
        if node.id in names:
            return names[node.id]
        if node.id in self.local:
            raise Refused(node, f"{node.id!r} has no value on some way that leads here")
        if node.id in OWN or node.id == "sqrt" or _callable(self.scope.get(node.id)):
            raise Refused(node, f"{node.id!r} is called, not handed on")
        raise Refused(node, f"{node.id!r} is neither an argument, a kernel nor a record")

    def _unary(self, node: ast.UnaryOp, names: dict[str, Kind]) -> Kind:
        if isinstance(node.op, ast.Not):
            self.truth(node.operand, names)
            return bool
        kind = self.of(node.operand, names)
        if not isinstance(node.op, ast.USub) or not (kind in NUMBERS or isinstance(kind, Literal)):
            raise Refused(
                node, f"`-` is of numbers and `not` of truth values, this is {shown(kind)}"
            )
        return kind

    def _binary(self, node: ast.BinOp, names: dict[str, Kind]) -> Kind:
        left, right = self.of(node.left, names), self.of(node.right, names)
        if message := OPERATORS.get(type(node.op)):
            raise Refused(node, message)
        if isinstance(left, Literal) and isinstance(right, Literal):
            return _literal(node, left, right)
        both = merged(left, right)
        wanted: tuple[Any, ...] = NUMBERS
        if isinstance(node.op, ast.Div):
            wanted = (float,)
        elif isinstance(node.op, ast.BitAnd | ast.BitOr):
            wanted = (int,)
        if both not in wanted:
            raise Refused(
                node, f"no such operation of {shown(left)} and {shown(right)}: numbers of one kind"
            )
        return both

    def _compare(self, node: ast.Compare, names: dict[str, Kind]) -> Kind:
        sides = [node.left, *node.comparators]
        kinds = [self.of(side, names) for side in sides]
        for operator, left, right in zip(node.ops, kinds, kinds[1:], strict=False):
            if not isinstance(operator, (*ORDER, ast.Eq, ast.NotEq)):
                raise Refused(
                    node,
                    "comparisons are < <= > >= == !=, never `is` or `in`: identity is no value",
                )
            if not self.comparable(left, right, isinstance(operator, ORDER)):
                raise Refused(
                    node,
                    f"{shown(left)} is compared with {shown(right)}: compare numbers of one kind",
                )
        return bool

    def items(self, loop: ast.For, names: dict[str, Kind]) -> dict[str, Kind]:
        """The names that a loop binds: kernels have no loops."""
        raise Refused(loop, "loops over data are `fold`s over a kernel step")

    def comparable(self, one: Kind, other: Kind, order: bool) -> bool:
        """Whether two kinds may be compared: numbers of one kind; truth values unless for order."""
        both = merged(one, other)
        return both in NUMBERS or isinstance(both, Literal) or (both is bool and not order)

    def _field(self, node: ast.Attribute, names: dict[str, Kind]) -> Kind:
        kind = self.of(node.value, names)
        if not hasattr(kind, "_fields") or node.attr not in kind._fields:
            raise Refused(node, f"{shown(kind)} has no field {node.attr!r}")
        return get_type_hints(kind)[node.attr]

    def _call(self, node: ast.Call, names: dict[str, Kind]) -> Kind:
        if not isinstance(node.func, ast.Name):
            raise Refused(node, "call kernels by their name")
        name = node.func.id
        if name in self.local:
            raise Refused(node, f"{name!r} is a local name: call kernels by their name")
        value: Any = self.scope.get(name, getattr(builtins, name, None))
        if name in OWN or name == "sqrt":
            return self._own(node, name, value, names)
        entry = entry_of(value)
        if entry is not None and entry.kind == "kernel":
            hints = get_type_hints(value)
            result = hints.pop("return")
            self._arguments(node, list(inspect.signature(value).parameters), hints, names)
            return result
        if is_record(value):
            self._arguments(node, list(value._fields), get_type_hints(value), names)
            return value
        raise Refused(
            node, f"{name!r} is neither a kernel nor a record without behaviour (fields alone)"
        )

    def _arguments(
        self, node: ast.Call, order: list[str], hints: dict[str, Kind], names: dict[str, Kind]
    ) -> None:
        if any(isinstance(a, ast.Starred) for a in node.args) or any(
            k.arg is None for k in node.keywords
        ):
            raise Refused(node, INSTEAD[ast.Starred])
        given = dict(zip(order, node.args, strict=False))
        more = {str(k.arg): k.value for k in node.keywords}
        if len(node.args) > len(order) or given.keys() & more.keys():
            raise Refused(node, "an argument is given twice, or more than there are")
        given |= more
        if given.keys() != set(order):
            raise Refused(node, f"its arguments are {', '.join(order)}")
        for part, value in given.items():
            kind = self.of(value, names)
            if not fits(kind, hints[part]):
                raise Refused(value, f"{part!r} is {shown(hints[part])}, this is {shown(kind)}")

    def _own(self, node: ast.Call, name: str, value: Any, names: dict[str, Kind]) -> Kind:
        if not is_root(value) if name == "sqrt" else value is not OWN[name]:
            raise Refused(node, f"{name!r} is not Python's own here: give yours another name")
        fewest, most = (2, 99) if name in ("min", "max") else (1, 1)
        if node.keywords or not fewest <= len(node.args) <= most:
            raise Refused(node, f"{name} of {'numbers' if most > 1 else 'one number'}, written out")
        kinds = [self.of(argument, names) for argument in node.args]
        both: Kind | None = kinds[0]
        for kind in kinds[1:]:
            both = None if both is None else merged(both, kind)
        if name == "sqrt" and both is not None and fits(both, float):
            return float
        if name == "sqrt" or not (both in NUMBERS or isinstance(both, Literal)):
            raise Refused(node, f"{name} is of numbers of one kind")
        return both


def _callable(value: Any) -> bool:
    return entry_of(value) is not None or inspect.isclass(value)


def _constant(node: ast.Constant) -> Kind:
    if isinstance(node.value, bool):
        return bool
    if not isinstance(node.value, int):
        raise Refused(node, f"the literal {node.value!r}: only integers and truth values are exact")
    if abs(node.value) >= INT64:
        raise Refused(node, f"{node.value} is no integer of 64 bits")
    return Literal(abs(node.value))


def _literal(node: ast.BinOp, left: Literal, right: Literal) -> Kind:
    """The kind of an integer computed from two written ones; Refused if its bound does not fit in 64 bits."""
    match node.op:
        case ast.Add() | ast.Sub():
            bound = left.bound + right.bound
        case ast.Mult():
            bound = left.bound * right.bound
        case ast.BitAnd() | ast.BitOr():
            return int
        case _:
            raise Refused(node, "write the quotient of two written integers as a product elsewhere")
    if bound >= INT64:
        raise Refused(node, "no integer of 64 bits is sure to hold this")
    return Literal(bound)
