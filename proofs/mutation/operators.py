"""Small faults in a function: each mutant differs from it in one place of its syntax tree.

Operators: comparisons relaxed or reversed, arithmetic operators exchanged, signs, integer constants by one, truth
values flipped, conjuncts and disjuncts dropped, `and`/`or` exchanged, conditions negated, branches (with their
returns) dropped, variables and fields of one type exchanged, arguments of a call exchanged, min/max exchanged, abs
dropped. The order is that of the source, so it is the same in every run; mutants with the same text are made once.
"""

from __future__ import annotations

import ast
import copy
import difflib
import inspect
import sys
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, get_type_hints

Variant = tuple[str, Callable[[Any], ast.AST | list[ast.stmt]]]

COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.Gt, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt, ast.GtE),
    ast.Gt: (ast.GtE, ast.Lt, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt, ast.LtE),
    ast.Eq: (ast.NotEq, ast.LtE, ast.GtE),
    ast.NotEq: (ast.Eq, ast.Lt, ast.Gt),
}
ARITHMETIC: dict[type[ast.operator], tuple[type[ast.operator], ...]] = {
    ast.Add: (ast.Sub, ast.Mult),
    ast.Sub: (ast.Add, ast.Mult),
    ast.Mult: (ast.Add, ast.Sub),
    ast.Div: (ast.Mult,),
    ast.BitAnd: (ast.BitOr,),
    ast.BitOr: (ast.BitAnd,),
    ast.BitXor: (ast.BitOr,),
    ast.LShift: (ast.RShift,),
    ast.RShift: (ast.LShift,),
}
MOST_NAMES = 4
"""The number of other variables of the same type that are tried in each place, nearest first."""


@dataclass(frozen=True)
class Mutant:
    """One fault: operator, line of the file, the line before and after, the mutated function.

    text: the whole function with the fault in it.
    """

    operator: str
    line: int
    diff: str
    function: Callable[..., Any]
    text: str


def mutants(function: Callable[..., Any]) -> Iterator[Mutant]:
    """Every mutant of a function, in the order of its source, generated lazily."""
    source, first = inspect.getsourcelines(function)
    tree = ast.parse(textwrap.dedent("".join(source)))
    node = tree.body[0]
    if not isinstance(node, ast.FunctionDef):
        raise TypeError(f"{function!r} is no function definition")
    _bare(node)
    original = ast.unparse(node)
    types = _Types(function, node)
    seen = {original}
    places = [n for statement in node.body for n in ast.walk(statement)]
    for number, place in enumerate(places):
        for name, change in _variants(place, types, node):
            text, changed = _apply(node, number, change)
            if text in seen:
                continue
            seen.add(text)
            line = first + getattr(place, "lineno", 1) - 1
            diff, faulty = _diff(original, text), _function(function, changed)
            yield Mutant(name, line, diff, faulty, text)


def _bare(node: ast.FunctionDef) -> None:
    """Remove decorators, annotations and docstring, leaving what the function does."""
    node.decorator_list, node.returns = [], None
    for argument in node.args.args:
        argument.annotation = None
    if ast.get_docstring(node):
        node.body = node.body[1:]


def _apply(node: ast.FunctionDef, number: int, change: Callable[[Any], Any]) -> tuple[str, Any]:
    changed = copy.deepcopy(node)
    place = [n for statement in changed.body for n in ast.walk(statement)][number]
    _replace(changed, place, change(place))
    ast.fix_missing_locations(changed)
    return ast.unparse(changed), changed


def _replace(tree: ast.AST, old: ast.AST, new: ast.AST | list[ast.stmt]) -> None:
    for parent in ast.walk(tree):
        for name, value in ast.iter_fields(parent):
            if value is old:
                setattr(parent, name, new)
            elif isinstance(value, list) and any(item is old for item in value):
                at = next(k for k, item in enumerate(value) if item is old)
                value[at : at + 1] = new if isinstance(new, list) else [new]
                if not value and name == "body":
                    value.append(ast.Pass())


def _function(original: Callable[..., Any], node: ast.FunctionDef) -> Callable[..., Any]:
    module = sys.modules[original.__module__]
    scope = dict(vars(module))
    code = compile(ast.Module([node], []), f"<mutant of {original.__name__}>", "exec")
    exec(code, scope)
    made: Callable[..., Any] = scope[original.__name__]
    return made


def _diff(before: str, after: str) -> str:
    """The changed lines, as `- old + new` in one line."""
    lines = list(difflib.ndiff(before.splitlines(), after.splitlines()))
    gone = " ".join(x[2:].strip() for x in lines if x.startswith("- "))
    come = " ".join(x[2:].strip() for x in lines if x.startswith("+ "))
    return f"- {gone} + {come}" if come else f"- {gone}"


class _Types:
    """The types of names and expressions of a function, as far as they can be inferred."""

    def __init__(self, function: Callable[..., Any], node: ast.FunctionDef) -> None:
        self.scope = function.__globals__
        hints = get_type_hints(function)
        self.names: dict[str, Any] = {k: v for k, v in hints.items() if k != "return"}
        self.since = dict.fromkeys(self.names, 0)
        for statement in ast.walk(node):
            if isinstance(statement, ast.Assign) and len(statement.targets) == 1:
                self._learn(statement.targets[0], self.of(statement.value), statement.lineno)

    def _learn(self, target: ast.expr, kind: Any, line: int) -> None:
        if isinstance(target, ast.Name) and target.id not in self.names and kind is not None:
            self.names[target.id], self.since[target.id] = kind, line
        if isinstance(target, ast.Tuple):
            fields = list(_fields(kind).values()) or [kind] * len(target.elts)
            for part, field in zip(target.elts, fields, strict=False):
                self._learn(part, field, line)

    def of(self, node: ast.expr) -> Any:
        """The type of an expression; None where it cannot be inferred."""
        if isinstance(node, ast.Name):
            return self.names.get(node.id)
        if isinstance(node, ast.Constant):
            return type(node.value)
        if isinstance(node, ast.Attribute):
            return _fields(self.of(node.value)).get(node.attr)
        if isinstance(node, ast.Compare | ast.BoolOp):
            return bool
        if isinstance(node, ast.UnaryOp):
            return bool if isinstance(node.op, ast.Not) else self.of(node.operand)
        if isinstance(node, ast.BinOp):
            both = {self.of(node.left), self.of(node.right)}
            return float if float in both else int if both == {int} else None
        if isinstance(node, ast.Tuple):
            kinds = {self.of(part) for part in node.elts}
            return kinds.pop() if len(kinds) == 1 else None
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            if node.func.id in ("abs", "min", "max", "sqrt"):
                kinds = {self.of(argument) for argument in node.args}
                return float if float in kinds else int if kinds == {int} else None
            called = self.scope.get(node.func.id)
            if inspect.isclass(called):
                return called
            return get_type_hints(called).get("return") if called is not None else None
        return None

    def others(self, name: str, line: int) -> list[str]:
        """Other variables of the same type that exist at this line, nearest first."""
        kind = self.names.get(name)
        known = [n for n, k in self.names.items() if k is kind and self.since[n] < line]
        if name not in known:
            return []
        at = known.index(name)
        near = sorted((abs(k - at), k) for k in range(len(known)) if k != at)
        return [known[k] for _, k in near[:MOST_NAMES]]


def _fields(kind: Any) -> dict[str, Any]:
    return get_type_hints(kind) if inspect.isclass(kind) and issubclass(kind, tuple) else {}


def _variants(node: ast.AST, types: _Types, within: ast.FunctionDef) -> Iterator[Variant]:
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        yield from _comparison(node, types)
    elif isinstance(node, ast.BinOp):
        for other in ARITHMETIC.get(type(node.op), ()):
            yield "arithmetic", partial(_operation, other)
        if types.of(node) in (int, float) and type(node.op) in (ast.Add, ast.Sub, ast.Mult):
            yield "sign", _negated
    elif isinstance(node, ast.Constant):
        yield from _constant(node)
    elif isinstance(node, ast.BoolOp):
        yield from _connective(node, types)
    elif isinstance(node, ast.UnaryOp):
        yield "sign" if isinstance(node.op, ast.USub) else "negation", lambda n: n.operand
    elif isinstance(node, ast.If):
        yield "branch dropped", lambda n: list(n.orelse)
        yield "branch always", lambda n: list(n.body)
        if not isinstance(node.test, ast.Compare):
            yield "negation", lambda n: ast.If(_not(n.test), n.body, n.orelse)
    elif isinstance(node, ast.Return) and node.value is not None:
        if types.of(node.value) is bool and not isinstance(node.value, ast.Compare | ast.Constant):
            yield "negation", lambda n: ast.Return(_not(n.value))
    elif isinstance(node, ast.Call):
        yield from _call(node, types)
    elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
        for name in types.others(node.id, node.lineno):
            yield "variable", partial(_named, name)
        if types.of(node) in (int, float) and _signs_count(node, within):
            yield "sign", _negated
    elif isinstance(node, ast.Attribute):
        fields = _fields(types.of(node.value))
        for name, kind in fields.items():
            if name != node.attr and kind is fields.get(node.attr):
                yield "field", partial(_field, name)
        if types.of(node) in (int, float) and _signs_count(node, within):
            yield "sign", _negated


def _operation(kind: type[ast.operator], node: ast.BinOp) -> ast.expr:
    return ast.BinOp(node.left, kind(), node.right)


def _compared(kind: type[ast.cmpop], node: ast.Compare) -> ast.expr:
    return ast.Compare(node.left, [kind()], node.comparators)


def _named(name: str, node: ast.Name) -> ast.expr:
    return ast.Name(name, ast.Load())


def _field(name: str, node: ast.Attribute) -> ast.expr:
    return ast.Attribute(node.value, name, ast.Load())


def _negated(node: Any) -> ast.AST:
    return ast.UnaryOp(ast.USub(), node)


def _not(node: Any) -> ast.expr:
    return ast.UnaryOp(ast.Not(), node)


def _signs_count(node: ast.AST, within: ast.FunctionDef) -> bool:
    """Whether a change of sign is tried here: inside a product it would repeat that of the product."""
    for parent in ast.walk(within):
        if any(child is node for child in ast.iter_child_nodes(parent)):
            if isinstance(parent, ast.BinOp):
                return not isinstance(parent.op, ast.Mult | ast.Div)
            return isinstance(parent, ast.Compare | ast.Call | ast.Return)
    return False


def _comparison(node: ast.Compare, types: _Types) -> Iterator[Variant]:
    truths = bool in (types.of(node.left), types.of(node.comparators[0]))
    for other in COMPARISONS.get(type(node.ops[0]), ()):
        if not truths or other in (ast.Eq, ast.NotEq):
            yield "comparison", partial(_compared, other)


def _constant(node: ast.Constant) -> Iterator[Variant]:
    if isinstance(node.value, bool):
        yield "constant", lambda n: ast.Constant(not n.value)
    elif isinstance(node.value, int):
        yield "constant", lambda n: ast.Constant(n.value + 1)
        yield "constant", lambda n: ast.Constant(n.value - 1)


def _connective(node: ast.BoolOp, types: _Types) -> Iterator[Variant]:
    swapped = ast.Or if isinstance(node.op, ast.And) else ast.And
    yield "connective", lambda n: ast.BoolOp(swapped(), n.values)
    for k in range(len(node.values)):
        yield "part dropped", partial(_without, k)
        if not isinstance(node.values[k], ast.Compare):
            yield "negation", partial(_inverted, k)


def _without(k: int, node: ast.BoolOp) -> ast.expr:
    rest = [v for j, v in enumerate(node.values) if j != k]
    return rest[0] if len(rest) == 1 else ast.BoolOp(node.op, rest)


def _inverted(k: int, node: ast.BoolOp) -> ast.expr:
    return ast.BoolOp(node.op, [_not(v) if j == k else v for j, v in enumerate(node.values)])


def _call(node: ast.Call, types: _Types) -> Iterator[Variant]:
    name = node.func.id if isinstance(node.func, ast.Name) else ""
    if name in ("min", "max"):
        other = "max" if name == "min" else "min"
        yield "call", lambda n: ast.Call(ast.Name(other, ast.Load()), n.args, [])
        return
    if name == "abs":
        yield "call", lambda n: n.args[0]
        return
    kinds = [types.of(argument) for argument in node.args]
    for k in range(len(kinds) - 1):
        same = kinds[k] is kinds[k + 1] or {kinds[k], kinds[k + 1]} == {int, float}
        if kinds[k] is not None and same:
            yield "arguments", partial(_exchanged, k)


def _exchanged(k: int, node: ast.Call) -> ast.expr:
    items = node.args
    return ast.Call(node.func, [*items[:k], items[k + 1], items[k], *items[k + 2 :]], [])
