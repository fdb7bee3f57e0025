"""The float filter: a kernel on doubles that detects when rounding could have changed its verdict.

A transformation of the kernel's graph. Beside every real value v of the graph, which represents the real number r,
there is a *size* p, the same expression on magnitudes, and a bound accumulated along the way: |v - r| <= factor * p +
slack and |v| <= p, for every input on which p is finite. A comparison a ? b becomes the sign of the difference v of
the two, certain where |v| > factor * p + slack as computed in doubles. `and or not if` are evaluated with three
values, so that the verdict is certain wherever the certain comparisons determine it. Any overflow makes p infinite or
NaN, and then nothing is certain. `proofs/methods/rounding.py` proves the rules below, one obligation for each rule
and each pair of bounds that occurs.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from cratous.core.readings.exact.certainty import surely_above, surely_below
from cratous.core.readings.exact.error_bounds import (
    EXACT,
    FLOOR,
    LARGEST,
    UNIT,
    Bound,
    bound_of_choice,
    bound_of_double,
    bound_of_product,
    bound_of_sum,
    bound_without_slack,
    threshold,
)
from cratous.core.readings.graph import inlined, program
from cratous.core.readings.graph.nodes import Node, NotInSubset, Program, Terms, leaves, ordered

FALSE, TRUE, UNDECIDED = 0, 1, 2


@dataclass(frozen=True)
class Step:
    """One application of a rule, for the prover: name, bounds before and after, constants used."""

    rule: str
    before: tuple[Bound, ...]
    after: Bound
    constants: tuple[Fraction, ...] = ()


@dataclass(frozen=True)
class Sided:
    """A value on doubles with its size and bound."""

    value: Node
    size: Node
    bound: Bound


@dataclass(frozen=True)
class Certain:
    """A truth value: surely true, surely false; `sharp` if always one of the two."""

    yes: Node
    no: Node
    sharp: bool = False


@dataclass(frozen=True)
class Compared:
    """A comparison of the kernel's graph, and how it is decided here.

    bound: of the difference; None where both sides are exact; `above`, `below` are then None too, otherwise the nodes
    of `surely_above` and `surely_below`.
    """

    original: Node
    certain: Certain
    bound: Bound | None = None
    above: Node | None = None
    below: Node | None = None


@dataclass(frozen=True, eq=False)
class Filter:
    """A filtered kernel: columns and results as nodes of `terms`, and the steps that led to it.

    sure: the result is certain. yes, no: of a truth value (else None); values: of the others.
    """

    program: Program
    terms: Terms
    results: tuple[Certain | Node, ...]
    sure: Node
    steps: tuple[Step, ...]
    compared: tuple[Compared, ...]
    states: tuple[tuple[Node, Certain], ...]


def filtered(
    kernel: Callable[..., Any] | Program, unit: Fraction = UNIT, *, shrink: float = 1.0
) -> Filter:
    """The filter of a division-free kernel; raises NotInSubset if there is none.

    unit and shrink exist for tests: a filter made with less than the true unit, or with its thresholds shrunk, must
    be refuted by the prover and detected by the comparison with rationals.
    """
    source = kernel if isinstance(kernel, Program) else program(kernel)
    if source.divides:
        raise NotInSubset(f"{source.name} divides or takes a root: it has no exact reading")
    return _Maker(source, unit, shrink).make()


class _Maker:
    def __init__(self, source: Program, unit: Fraction, shrink: float) -> None:
        self.source, self.unit, self.shrink = source, unit, shrink
        self.terms = Terms()
        self.reals: dict[int, Sided] = {}
        self.truths: dict[int, Certain] = {}
        self.others: dict[int, Node] = {}
        self.steps: list[Step] = []
        self.compared: list[Compared] = []
        self.bounds: list[Node] = []
        self.sizes: list[Node] = []
        self.needed: list[Node] = []

    def make(self) -> Filter:
        for node in self.source.nodes:
            if node.kind == "float":
                self.reals[node.number] = self.real(node)
            elif node.kind == "bool":
                self.truths[node.number] = self.truth(node)
            else:
                self.others[node.number] = self.other(node)
        results: list[Certain | Node] = []
        for leaf in leaves(self.source.result):
            if leaf.kind == "float":
                results.append(self.reals[leaf.number].value)
                if not self.reals[leaf.number].bound.exact:
                    self.needed.append(self.terms.literal(False, "bool"))
            elif leaf.kind == "bool":
                results.append(self.truths[leaf.number])
            else:
                results.append(self.others[leaf.number])
        sure = functools.reduce(self.terms.both, [*self.needed, self.finite()])
        return Filter(
            self.source,
            self.terms,
            tuple(results),
            sure,
            tuple(self.steps),
            tuple(self.compared),
            tuple((n, self.truths[n.number]) for n in self.source.nodes if n.kind == "bool"),
        )

    # -- reals --------------------------------------------------------------------------
    def size(self, value: Node) -> Node:
        """|value|, which is the value itself if that is a square or a magnitude."""
        if value.op == "lit":
            return self.terms.literal(abs(value.value), "float")
        if value.op == "abs" or (value.op == "mul" and value.args[0] is value.args[1]):
            return value
        inner = value.args[0] if value.op == "neg" else value
        return inner if inner is not value and inner.op == "abs" else self.plain("abs", inner)

    def plain(self, op: str, *args: Node) -> Node:
        return self.terms.node(op, args, "float")

    def note(
        self, rule: str, before: tuple[Bound, ...], after: Bound, *constants: Fraction
    ) -> Bound:
        step = Step(rule, before, after, constants)
        if step not in self.steps:
            self.steps.append(step)
        return after

    def exactly(self, value: Node) -> Sided:
        return Sided(value, self.size(value), EXACT)

    def real(self, node: Node) -> Sided:
        if node.op == "in":
            return self.exactly(self.terms.column(node.value, "float"))
        if node.op == "lit":
            return self.exactly(self.terms.literal(node.value, "float"))
        if node.op == "if":
            return self.chosen(node)
        parts = [self.reals[arg.number] for arg in node.args]
        if node.op in ("neg", "abs"):
            return self.signed(node.op, parts[0])
        a, b = parts
        if node.op in ("add", "sub"):
            return self.sum(node.op, a, b)
        if node.op == "mul":
            return self.product(a, b)
        return self.extreme(node.op, a, b)

    def signed(self, op: str, a: Sided) -> Sided:
        if op == "neg" and a.value.op == "neg":
            return Sided(a.value.args[0], a.size, a.bound)
        return Sided(self.plain(op, a.value), a.size, a.bound)

    def sum(self, op: str, a: Sided, b: Sided) -> Sided:
        if b.value.op == "lit" and b.value.value == 0:
            return a
        if a.value.op == "lit" and a.value.value == 0:
            return b if op == "add" else self.signed("neg", b)
        bound = bound_of_sum(a.bound, b.bound, self.unit)
        self.note("sum", (a.bound, b.bound), bound)
        return Sided(self.plain(op, a.value, b.value), self.plain("add", a.size, b.size), bound)

    def lifted(self, a: Sided) -> Sided:
        """The same value with the underflow part of its error moved into its size."""
        if not a.bound.slack:
            return a
        bound = self.note("floor", (a.bound,), bound_without_slack(a.bound))
        floor = self.terms.literal(float(FLOOR), "float")
        return Sided(a.value, self.plain("add", a.size, floor), bound)

    def product(self, a: Sided, b: Sided) -> Sided:
        for one, other in ((a, b), (b, a)):
            known = one.value.value if one.value.op == "lit" else 0
            if known >= 1 and math.frexp(known)[0] == 0.5:
                times = int(known)
                after = bound_of_double(other.bound, times)
                bound = self.note("double", (other.bound,), after, Fraction(times))
                value, size = (self.plain("mul", one.value, x) for x in (other.value, other.size))
                return Sided(value, size, bound)
        a, b = self.lifted(a), self.lifted(b)
        value = self.plain("mul", a.value, b.value)
        bound = bound_of_product(a.bound, b.bound, self.unit)
        self.note("product", (a.bound, b.bound), bound)
        # |x| * |y| rounds to |x * y|: the size of a product of such sizes costs nothing
        own = a.size is self.size(a.value) and b.size is self.size(b.value)
        return Sided(value, self.size(value) if own else self.plain("mul", a.size, b.size), bound)

    def extreme(self, op: str, a: Sided, b: Sided) -> Sided:
        value = self.plain(op, a.value, b.value)
        if a.bound.exact and b.bound.exact:
            return self.exactly(value)
        bound = self.note(op, (a.bound, b.bound), bound_of_choice(a.bound, b.bound))
        # the sum of the sizes, not the greater: a NaN must not get lost
        return Sided(value, self.plain("add", a.size, b.size), bound)

    def chosen(self, node: Node) -> Sided:
        condition = self.truths[node.args[0].number]
        self.require(condition)
        a, b = (self.reals[arg.number] for arg in node.args[1:])
        value = self.terms.node("if", (condition.yes, a.value, b.value), "float")
        if a.bound.exact and b.bound.exact:
            return self.exactly(value)
        bound = self.note("choice", (a.bound, b.bound), bound_of_choice(a.bound, b.bound))
        size = self.terms.node("if", (condition.yes, a.size, b.size), "float")
        return Sided(value, size, bound)

    # -- truth values and integers ------------------------------------------------------
    def require(self, condition: Certain) -> None:
        """The whole result is certain only where this condition is."""
        if not condition.sharp:
            known = self.terms.either(condition.yes, condition.no)
            if known not in self.needed:
                self.needed.append(known)

    def truth(self, node: Node) -> Certain:
        terms = self.terms
        if node.op == "in":
            return self.sharp(terms.column(node.value, "bool"))
        if node.op == "lit":
            return self.sharp(terms.literal(node.value, "bool"))
        if node.op in ("not", "and", "or", "xor"):
            parts = [self.truths[arg.number] for arg in node.args]
            return self.logic(node.op, parts)
        if node.args[0].kind == "int":
            a, b = (self.others[arg.number] for arg in node.args)
            return self.sharp(terms.compare(node.op, a, b))
        return self.comparison(node)

    def sharp(self, yes: Node) -> Certain:
        return Certain(yes, self.terms.negate(yes), True)

    def logic(self, op: str, parts: list[Certain]) -> Certain:
        terms, a = self.terms, parts[0]
        if op == "not":
            return Certain(a.no, a.yes, a.sharp)
        b = parts[1]
        if op == "and":
            yes, no = terms.both(a.yes, b.yes), terms.either(a.no, b.no)
        elif op == "or":
            yes, no = terms.either(a.yes, b.yes), terms.both(a.no, b.no)
        else:
            yes = terms.either(terms.both(a.yes, b.no), terms.both(a.no, b.yes))
            no = terms.either(terms.both(a.yes, b.yes), terms.both(a.no, b.no))
        if a.sharp and b.sharp:
            return self.sharp(terms.differ(a.yes, b.yes) if op == "xor" else yes)
        return Certain(yes, no)

    def comparison(self, node: Node) -> Certain:
        a, b = (self.reals[arg.number] for arg in node.args)
        if a.bound.exact and b.bound.exact:
            sharp = self.sharp(self.terms.compare(node.op, a.value, b.value))
            for side in (a, b):
                # a doubled value may overflow, and then it is not exact
                if any(part.op == "mul" for part in ordered([side.value])):
                    self.bounds.append(side.size)
                    self.sizes.append(side.size)
            self.compared.append(Compared(node, sharp))
            return sharp
        found = self.sum("sub", a, b)
        factor, least = threshold(found.bound)
        factor *= self.shrink
        real = self.terms.literal
        bound = self.plain("mul", real(factor, "float"), found.size)
        bound = self.plain("add", bound, real(least, "float"))
        self.note("sign", (found.bound,), found.bound, Fraction(factor), Fraction(least))
        if bound not in self.bounds:
            self.bounds.append(bound)
        above = inlined(self.terms, surely_above, found.value, bound)
        below = inlined(self.terms, surely_below, found.value, bound)
        never = real(False, "bool")
        apart = self.terms.either(above, below)
        yes, no = {
            "gt": (above, below),
            "ge": (above, below),
            "lt": (below, above),
            "le": (below, above),
            "eq": (never, apart),
            "ne": (apart, never),
        }[node.op]
        certain = Certain(yes, no)
        self.compared.append(Compared(node, certain, found.bound, above, below))
        return certain

    def other(self, node: Node) -> Node:
        if node.op in ("in", "lit"):
            return self.terms.node(node.op, (), "int", node.value)
        if node.op == "if":
            condition = self.truths[node.args[0].number]
            self.require(condition)
            a, b = (self.others[arg.number] for arg in node.args[1:])
            return self.terms.node("if", (condition.yes, a, b), "int")
        return self.terms.node(node.op, tuple(self.others[a.number] for a in node.args), "int")

    # -- finite input -------------------------------------------------------------------
    def finite(self) -> Node:
        """True only if every real column is finite: the sum of bounds that together contain each column.

        A bound is finite only if every column in it is; one behind a choice may not be evaluated, so it is added
        separately. A bound that is not finite decides nothing, so bounds that add no further column are omitted;
        sizes of exact values are all included.
        """
        covered: set[Any] = set()
        total = []
        seen = {bound: _columns(bound) for bound in self.bounds}
        for bound in sorted(self.bounds, key=lambda b: (b not in self.sizes, -len(seen[b]))):
            if bound in self.sizes or seen[bound] - covered:
                total.append(bound)
                covered |= seen[bound]
        for column in self.source.columns:
            if column.kind == "float" and column.value not in covered:
                total.append(self.plain("abs", self.terms.column(column.value, "float")))
        if not total:
            return self.terms.literal(True, "bool")
        summed = functools.reduce(functools.partial(self.plain, "add"), total)
        return self.terms.compare("le", summed, self.terms.literal(LARGEST, "float"))


def _columns(bound: Node) -> set[Any]:
    """The columns that make a bound not finite where they are not."""
    found: set[Any] = set()
    todo = [bound]
    while todo:
        node = todo.pop()
        if node.op == "in":
            found.add(node.value)
        elif node.op not in ("if", "min", "max"):
            todo += node.args
    return found
