"""The steps to the sign of one difference, over a work array with fixed locations.

Columns, literals and conditions have a location of one double each, the same for every comparison of a kernel;
results of steps follow them, each with space for its greatest length.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from cratous.core.readings.exact.expansion_arithmetic import (
    ABS,
    ADD,
    ADD2,
    CROSS,
    DOT,
    LONGEST,
    MUL,
    MUL2,
    PICK,
    PICK_NOT,
    SCALE,
    SUB,
    SUB2,
    TIMES,
)
from cratous.core.readings.graph.nodes import Node
from cratous.core.readings.graph.printing import name


@dataclass(frozen=True)
class Cell:
    """A value in the work array: its number, its location, its greatest length; one double or more."""

    number: int
    place: int
    longest: int = 1
    double: bool = False


class Layout:
    """The locations shared by all comparisons of a kernel, and the number of values.

    known: the first of the locations of the comparisons' signs; want: the location of the number of the one that is
    missing.
    """

    def __init__(self, nodes: Sequence[Node], comparisons: int) -> None:
        self.fixed: dict[str, Cell] = {}
        self.values = 0
        self.base = 0
        for node in nodes:
            if node.kind == "float" and node.op in ("in", "lit"):
                self.fix(name(node))
            elif node.kind == "float" and node.op == "if":
                self.fix(f"d{node.number}")
        for sign in ("1.0", "-1.0"):
            self.fix(sign)
        self.known = len(self.fixed)
        self.want = self.known + comparisons
        self.base = self.want + 1

    def fix(self, text: str) -> Cell:
        """The location of a column, literal or condition."""
        if text not in self.fixed:
            if self.base:
                raise ValueError(f"{text} has no place, and what comes behind is taken")
            self.fixed[text] = Cell(self.values, len(self.fixed), double=True)
            self.values += 1
        return self.fixed[text]


class Steps:
    """The steps of one comparison."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.steps: list[tuple[int, ...]] = []
        self.made: dict[int, Cell] = {}
        self.free = layout.base

    def room(self, longest: int) -> int:
        at = self.free
        self.free += min(longest, LONGEST) + 2
        return at

    def step(
        self, op: int, x: Cell, y: Cell, longest: int, extra: tuple[int, int] | None = None
    ) -> Cell:
        at = self.room(longest)
        if op == MUL:
            extra = (self.room(2 * max(x.longest, y.longest)), self.room(longest))
        made = Cell(self.layout.values, at, min(longest, LONGEST))
        self.layout.values += 1
        more = extra or (0, 0)
        self.steps.append((op, x.number, y.number, made.number, x.place, y.place, at, *more))
        return made

    def sum(self, x: Cell, y: Cell, sign: int) -> Cell:
        if x.double and y.double:
            return self.step(ADD2 if sign > 0 else SUB2, x, y, 2)
        return self.step(ADD if sign > 0 else SUB, x, y, x.longest + y.longest)

    def product(self, x: Cell, y: Cell) -> Cell:
        if x.double and y.double:
            return self.step(MUL2, x, y, 2)
        if x.double or y.double:
            x, y = (y, x) if x.double else (x, y)
            return self.step(SCALE, x, y, 2 * x.longest)
        return self.step(MUL, x, y, 2 * x.longest * y.longest)

    def cell(self, node: Node) -> Cell:
        """The cell of one real value of the graph; steps that fill it are added once."""
        if node.number not in self.made:
            self.made[node.number] = self.value(node)
        return self.made[node.number]

    def dot(self, node: Node) -> Cell | None:
        """The sum or difference of two products of doubles, in one step."""
        products = [arg for arg in node.args if arg.op == "mul" and arg.number not in self.made]
        factors = [self.cell(f) for arg in products for f in arg.args if f.op in ("in", "lit")]
        if len(products) != 2 or len(factors) != 4:
            return None
        x, y, u, v = factors
        op = DOT if node.op == "add" else CROSS
        return self.step(op, x, y, 4, (u.place, v.place))

    def value(self, node: Node) -> Cell:
        """The steps that compute one value from its operands."""
        layout = self.layout
        if node.op in ("in", "lit"):
            return layout.fix(name(node))
        if node.op in ("add", "sub"):
            made = self.dot(node)
            if made is not None:
                return made
        args = [self.cell(arg) for arg in node.args if arg.kind == "float"]
        x, y = args[0], args[-1]
        longest = max(x.longest, y.longest)
        if node.op == "if":
            condition = layout.fix(f"d{node.number}")
            made = self.step(PICK, x, y, longest, (condition.number, condition.place))
        elif node.op in ("add", "sub"):
            made = self.sum(x, y, 1 if node.op == "add" else -1)
        elif node.op == "mul":
            made = self.doubled(node, args) or self.product(x, y)
        elif node.op in ("neg", "abs"):
            op = TIMES if node.op == "neg" else ABS
            made = self.step(op, x, layout.fix("-1.0"), longest)
        else:
            gap = self.sum(x, y, -1)
            op = PICK if node.op == "min" else PICK_NOT
            made = self.step(op, x, y, longest, (gap.number, gap.place))
        return made

    def doubled(self, node: Node, args: list[Cell]) -> Cell | None:
        """The product with a power of two, which keeps the length."""
        for k in (0, 1):
            if node.args[k].op == "lit" and math.frexp(node.args[k].value)[0] == 0.5:
                return self.step(TIMES, args[1 - k], args[k], args[1 - k].longest)
        return None
