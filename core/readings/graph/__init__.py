"""A kernel as a graph of operations without control flow: the input of every generated reading.

The kernel's syntax tree is walked once, callees included; `if` becomes a choice between values, equal terms become
one node. Nothing is reordered: a node is the operation that CPython carries out, on the same operands. So the graph
of a kernel can be printed as straight-line code (compiled reading), be given error bounds (filter), be evaluated on
expansions and on integers (exact reading), and be compared with the lifted kernel by the prover.
"""

from __future__ import annotations

import ast
import functools
import inspect
from collections.abc import Callable, Iterator
from typing import Any, get_type_hints

from cratous.core.kernel.sources import is_root, text_of
from cratous.core.readings.graph.nodes import Node, NotInSubset, Program, Record, Terms, Value

COMPARISONS = {
    ast.Lt: "lt",
    ast.LtE: "le",
    ast.Gt: "gt",
    ast.GtE: "ge",
    ast.Eq: "eq",
    ast.NotEq: "ne",
}
ARITHMETIC = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div"}
MASKS = {ast.BitAnd: "bitand", ast.BitOr: "bitor"}


@functools.cache
def program(function: Callable[..., Any]) -> Program:
    """The graph of a kernel; raises NotInSubset where there is none."""
    terms = Terms()
    hints = get_type_hints(function)
    columns: list[Node] = []
    labels: list[str] = []

    def argument(name: str, label: str, kind: Any) -> Value:
        if inspect.isclass(kind) and issubclass(kind, tuple):
            fields = get_type_hints(kind)
            made = [
                argument(f"{name}_{k}", f"{label}.{field}", fields[field])
                for k, field in enumerate(fields)
            ]
            return Record(kind, tuple(made))
        if kind not in (float, int, bool):
            raise NotInSubset(f"{function.__name__}: {label} has the type {kind!r}")
        columns.append(terms.column(name, kind.__name__))
        labels.append(label)
        return columns[-1]

    arguments = [argument(n, n, hints[n]) for n in inspect.signature(function).parameters]
    result = _Walk(terms, function).call(arguments)
    return Program(function.__name__, terms, tuple(columns), tuple(labels), result)


def inlined(terms: Terms, function: Callable[..., Any], *args: Value) -> Node:
    """The result of a function of the subset on these nodes."""
    found = _Walk(terms, function).call(list(args))
    if isinstance(found, Record):
        raise NotInSubset(f"{function.__name__} gives a record")
    return found


@functools.cache
def _definition(function: Callable[..., Any]) -> ast.FunctionDef:
    tree = ast.parse(text_of(function))
    node = tree.body[0]
    if not isinstance(node, ast.FunctionDef):
        raise NotInSubset(f"{function!r} is no function definition")
    return node


def _within(statements: list[ast.stmt], kind: type) -> Iterator[Any]:
    for statement in statements:
        yield from (part for part in ast.walk(statement) if isinstance(part, kind))


class _Walk:
    """One pass over a function's syntax tree with nodes for its variables."""

    def __init__(self, terms: Terms, function: Callable[..., Any]) -> None:
        self.terms, self.function = terms, function
        self.hints = get_type_hints(function)

    def call(self, arguments: list[Value]) -> Value:
        definition = _definition(self.function)
        names = [argument.arg for argument in definition.args.args]
        if len(names) != len(arguments):
            raise self.outside(definition, f"called with {len(arguments)} arguments")
        pairs = zip(names, arguments, strict=True)
        scope = {name: self.cast(value, self.hints.get(name)) for name, value in pairs}
        found = self.block(definition.body, scope)
        if found is None:
            raise self.outside(definition, "a way through it ends without a result")
        return self.cast(found, self.hints.get("return"))

    def outside(self, at: ast.AST, what: str) -> NotInSubset:
        line = getattr(at, "lineno", 0)
        return NotInSubset(f"{self.function.__name__}, line {line} of it: {what}")

    def cast(self, value: Value, kind: Any) -> Value:
        if isinstance(value, Node) and kind is float:
            return self.terms.real(value)
        return value

    # -- statements ---------------------------------------------------------------------
    def block(self, statements: list[ast.stmt], scope: dict[str, Value]) -> Value | None:
        """Run statements; the returned value, or None if the end was reached."""
        for index, statement in enumerate(statements):
            if isinstance(statement, ast.Return) and statement.value is not None:
                return self.value(statement.value, scope)
            if isinstance(statement, ast.Assign):
                self.assign(statement.targets, self.value(statement.value, scope), scope)
            elif isinstance(statement, ast.AnnAssign) and statement.value is not None:
                self.assign([statement.target], self.value(statement.value, scope), scope)
            elif isinstance(statement, ast.If):
                condition = self.truth(statement.test, scope)
                ways = [statement.body, statement.orelse]
                if condition.op == "lit":
                    rest = [*ways[0 if condition.value else 1], *statements[index + 1 :]]
                    return self.block(rest, scope)
                if any(True for _ in _within([statement], ast.Return)):
                    scopes = [dict(scope), dict(scope)]
                    a, b = (
                        self.block([*way, *statements[index + 1 :]], inner)
                        for way, inner in zip(ways, scopes, strict=True)
                    )
                    if a is None or b is None:
                        raise self.outside(statement, "a way through it ends without a result")
                    return self.terms.choose(condition, a, b)
                self.merge(condition, ways, scope)
            elif isinstance(statement, ast.For):
                turns = self.turns(statement)
                if any(True for _ in _within(statement.body, ast.Return)):
                    rest = [s for turn in turns for s in (turn, *statement.body)]
                    return self.block([*rest, *statements[index + 1 :]], scope)
                for turn in turns:
                    self.block([turn, *statement.body], scope)
            elif not (
                isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
            ):
                raise self.outside(statement, f"{type(statement).__name__} is not in the subset")
        return None

    def turns(self, loop: ast.For) -> list[ast.stmt]:
        """`i = 0`, `i = 1`, ... for `for i in range(<literal>)`."""
        source = loop.iter
        if (
            isinstance(loop.target, ast.Name)
            and isinstance(source, ast.Call)
            and isinstance(source.func, ast.Name)
            and source.func.id == "range"
            and len(source.args) == 1
            and isinstance(source.args[0], ast.Constant)
            and isinstance(source.args[0].value, int)
            and not loop.orelse
            and not any(True for _ in _within(loop.body, ast.Break | ast.Continue))  # type: ignore[arg-type]
        ):
            made = [ast.Assign([loop.target], ast.Constant(k)) for k in range(source.args[0].value)]
            return [ast.copy_location(statement, loop) for statement in made]
        raise self.outside(loop, "loops run over range(<literal>)")

    def assign(self, targets: list[ast.expr], value: Value, scope: dict[str, Value]) -> None:
        for target in targets:
            if isinstance(target, ast.Name):
                scope[target.id] = value
            elif isinstance(target, ast.Tuple) and isinstance(value, Record):
                for part, field in zip(target.elts, value.fields, strict=True):
                    self.assign([part], field, scope)
            else:
                raise self.outside(target, "only names are assigned")

    def merge(self, condition: Node, ways: list[list[ast.stmt]], scope: dict[str, Value]) -> None:
        scopes = [dict(scope), dict(scope)]
        for way, inner in zip(ways, scopes, strict=True):
            self.block(way, inner)
        for name, a in scopes[0].items():
            if name in scopes[1]:
                scope[name] = self.terms.choose(condition, a, scopes[1][name])

    # -- expressions --------------------------------------------------------------------
    def truth(self, expression: ast.expr, scope: dict[str, Value]) -> Node:
        found = self.value(expression, scope)
        if isinstance(found, Record) or found.kind != "bool":
            raise self.outside(expression, "a condition is a truth value")
        return found

    def number(self, expression: ast.expr, scope: dict[str, Value]) -> Node:
        found = self.value(expression, scope)
        if isinstance(found, Record):
            raise self.outside(expression, "a record where a number is needed")
        return found

    def value(self, expression: ast.expr, scope: dict[str, Value]) -> Value:
        terms = self.terms
        match expression:
            case ast.Constant(value=bool() as known):
                return terms.literal(known, "bool")
            case ast.Constant(value=int() as known):
                return terms.literal(known, "int")
            case ast.Name(id=name):
                return scope[name] if name in scope else self.known(expression, name)
            case ast.Attribute(value=owner, attr=field):
                record = self.value(owner, scope)
                if isinstance(record, Record):
                    return record.fields[list(get_type_hints(record.kind)).index(field)]
            case ast.BoolOp(op=op, values=values):
                fold = terms.both if isinstance(op, ast.And) else terms.either
                return functools.reduce(fold, [self.truth(v, scope) for v in values])
            case ast.UnaryOp(op=ast.Not(), operand=operand):
                return terms.negate(self.truth(operand, scope))
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                inner = self.number(operand, scope)
                if inner.op == "lit":
                    return terms.literal(-inner.value, inner.kind)
                return terms.node("neg", (inner,), inner.kind)
            case ast.BinOp(left=left, op=op, right=right):
                a, b = self.number(left, scope), self.number(right, scope)
                if type(op) in ARITHMETIC:
                    return terms.arith(ARITHMETIC[type(op)], a, b)
                if type(op) in MASKS and a.kind == b.kind == "int":
                    return terms.node(MASKS[type(op)], (a, b), "int")
            case ast.Compare(left=left, ops=ops, comparators=others):
                items = [self.number(item, scope) for item in (left, *others)]
                found = [
                    terms.compare(COMPARISONS[type(op)], a, b)
                    for op, a, b in zip(ops, items, items[1:], strict=False)
                ]
                return functools.reduce(terms.both, found)
            case ast.Call(func=ast.Name(id=name), args=args):
                return self.called(expression, name, [self.value(a, scope) for a in args])
        raise self.outside(expression, f"`{ast.unparse(expression)}` is not in the subset")

    def known(self, at: ast.expr, name: str) -> Node:
        value = self.function.__globals__.get(name)
        if isinstance(value, bool):
            return self.terms.literal(value, "bool")
        if isinstance(value, int):
            return self.terms.literal(value, "int")
        raise self.outside(at, f"{name!r} is neither an argument nor a known integer")

    def called(self, at: ast.expr, name: str, args: list[Value]) -> Value:
        target = self.function.__globals__.get(name)
        if inspect.isclass(target) and issubclass(target, tuple):
            kinds = list(get_type_hints(target).values())
            if len(kinds) != len(args):
                raise self.outside(at, f"{name} has {len(kinds)} fields")
            pairs = zip(args, kinds, strict=True)
            return Record(target, tuple(self.cast(value, kind) for value, kind in pairs))
        if inspect.isfunction(target):
            return _Walk(self.terms, target).call(args)
        if name in ("abs", "min", "max", "sqrt") and (target is None or is_root(target)):
            nodes = [arg for arg in args if isinstance(arg, Node)]
            if len(nodes) != len(args) or not nodes:
                raise self.outside(at, f"{name} of a record")
            if name in ("min", "max"):
                return functools.reduce(functools.partial(self.extreme, name), nodes)
            inner = self.terms.real(nodes[0]) if name == "sqrt" else nodes[0]
            return self.terms.node(name, (inner,), inner.kind)
        raise self.outside(at, f"{name!r} is neither a kernel nor a record")

    def extreme(self, which: str, a: Node, b: Node) -> Node:
        a, b = self.terms.alike(a, b)
        return a if a is b else self.terms.node(which, (a, b), a.kind)
