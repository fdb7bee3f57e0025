"""Nodes and terms of a kernel's graph: operations without control flow, equal terms shared.

Nothing is reordered: a node is the operation that CPython carries out, on the same operands. `core.readings.graph`
makes them from a kernel's syntax tree.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

LIMIT = 20_000


class NotInSubset(TypeError):
    """A function that has no graph because part of it is outside the kernel subset."""


@dataclass(frozen=True, eq=False)
class Node:
    """One operation. kind: float, int or bool; value: the column's name or the literal."""

    op: str
    args: tuple[Node, ...]
    kind: str
    value: Any
    number: int


@dataclass(frozen=True)
class Record:
    """A NamedTuple whose fields are nodes or records."""

    kind: type
    fields: tuple[Value, ...]


Value = Node | Record


class Terms:
    """Makes nodes; equal ones are one object, and constants are folded where this involves no rounding."""

    def __init__(self) -> None:
        self.made: dict[Any, Node] = {}

    def node(self, op: str, args: tuple[Node, ...], kind: str, value: Any = None) -> Node:
        """The node of this operation, operands and value."""
        key = (op, tuple(a.number for a in args), kind, type(value), value)
        if key not in self.made:
            if len(self.made) >= LIMIT:
                raise NotInSubset(f"the graph has more than {LIMIT} operations")
            self.made[key] = Node(op, args, kind, value, len(self.made))
        return self.made[key]

    def column(self, name: str, kind: str) -> Node:
        """An argument."""
        return self.node("in", (), kind, name)

    def literal(self, value: Any, kind: str) -> Node:
        """A known value."""
        cast = {"float": float, "int": int, "bool": bool}[kind]
        if kind == "float" and cast(value) != value:
            raise NotInSubset(f"the literal {value!r} is no double")
        return self.node("lit", (), kind, cast(value))

    def arith(self, op: str, a: Node, b: Node) -> Node:
        """a op b, an integer literal beside a real becoming a real."""
        a, b = self.alike(a, b)
        if a.kind == "bool" or (op == "div" and a.kind != "float"):
            raise NotInSubset(f"{op} of {a.kind} operands")
        if a.kind == "int" and a.op == b.op == "lit" and op in ("add", "sub", "mul"):
            found = {"add": a.value + b.value, "sub": a.value - b.value, "mul": a.value * b.value}
            return self.literal(found[op], "int")
        return self.node(op, (a, b), a.kind)

    def alike(self, a: Node, b: Node) -> tuple[Node, Node]:
        """Both operands converted to one kind."""
        if a.kind != b.kind:
            if a.kind == "int" and b.kind == "float":
                a = self.real(a)
            elif a.kind == "float" and b.kind == "int":
                b = self.real(b)
            else:
                raise NotInSubset(f"{a.kind} beside {b.kind}")
        return a, b

    def real(self, a: Node) -> Node:
        """An integer literal as a real; integer and real variables do not mix."""
        if a.kind == "int" and a.op != "lit":
            raise NotInSubset("an integer variable beside a real")
        return a if a.kind == "float" else self.literal(a.value, "float")

    def compare(self, op: str, a: Node, b: Node) -> Node:
        """The truth value of a op b."""
        a, b = self.alike(a, b)
        if a.kind == "bool":
            found = self.differ(a, b)
            return found if op == "ne" else self.negate(found)
        if a.op == b.op == "lit":
            x, y = a.value, b.value
            table = {"lt": x < y, "le": x <= y, "gt": x > y, "ge": x >= y, "eq": x == y}
            return self.literal(table.get(op, x != y), "bool")
        return self.node(op, (a, b), "bool")

    def differ(self, a: Node, b: Node) -> Node:
        """a != b of two truth values."""
        for one, other in ((a, b), (b, a)):
            if one.op == "lit":
                return self.negate(other) if one.value else other
        return self.node("xor", (a, b), "bool")

    def negate(self, a: Node) -> Node:
        """not a."""
        if a.op == "lit":
            return self.literal(not a.value, "bool")
        return a.args[0] if a.op == "not" else self.node("not", (a,), "bool")

    def both(self, a: Node, b: Node) -> Node:
        """a and b."""
        for one, other in ((a, b), (b, a)):
            if one.op == "lit":
                return other if one.value else one
        return a if a is b else self.node("and", (a, b), "bool")

    def either(self, a: Node, b: Node) -> Node:
        """a or b."""
        for one, other in ((a, b), (b, a)):
            if one.op == "lit":
                return one if one.value else other
        return a if a is b else self.node("or", (a, b), "bool")

    def choose(self, condition: Node, a: Value, b: Value) -> Value:
        """a if condition else b."""
        if isinstance(a, Record) or isinstance(b, Record):
            if not (isinstance(a, Record) and isinstance(b, Record) and a.kind is b.kind):
                raise NotInSubset("two branches give results of different types")
            pairs = zip(a.fields, b.fields, strict=True)
            return Record(a.kind, tuple(self.choose(condition, x, y) for x, y in pairs))
        a, b = self.alike(a, b)
        if condition.op == "lit":
            return a if condition.value else b
        if a is b:
            return a
        if condition.op == "not":
            condition, a, b = condition.args[0], b, a
        if a.kind != "bool":
            return self.node("if", (condition, a, b), a.kind)
        if a.op == "lit":
            return self.either(condition, b) if a.value else self.both(self.negate(condition), b)
        if b.op == "lit":
            return self.either(self.negate(condition), a) if b.value else self.both(condition, a)
        yes, no = self.both(condition, a), self.both(self.negate(condition), b)
        return self.either(yes, no)


@dataclass(frozen=True)
class Program:
    """A kernel's graph: its terms, columns in order with name and kind, and the result."""

    name: str
    terms: Terms
    columns: tuple[Node, ...]
    labels: tuple[str, ...]
    result: Value

    @property
    def nodes(self) -> list[Node]:
        """What the result needs, operands first."""
        return ordered(leaves(self.result))

    @property
    def divides(self) -> bool:
        """True iff there is a division or a root, so that there is no exact reading."""
        return any(node.op in ("div", "sqrt") for node in self.nodes)


def leaves(value: Value) -> list[Node]:
    """The nodes of a possibly nested record, in order."""
    if isinstance(value, Node):
        return [value]
    return [node for field in value.fields for node in leaves(field)]


def ordered(roots: list[Node]) -> list[Node]:
    """All nodes that the roots need, operands before users."""
    seen: dict[int, Node] = {}
    todo = list(roots)
    while todo:
        node = todo.pop()
        if node.number not in seen:
            seen[node.number] = node
            todo += node.args
    return [seen[number] for number in sorted(seen)]
