"""The enclosed reading: an interval of doubles that contains the real value of a kernel.

For kernels with divisions and roots, which have no exact reading. The kernel's graph is evaluated on intervals; the
result of every operation that rounds is moved outward by `outward_margin` (a theorem says that this suffices,
underflow included). Where a condition is uncertain the result covers both branches. A value for which a division or a
root may be undefined is refused, unless the kernel itself tests for it (`if disc < 0: ...`) and so does not reach the
operation.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cratous.core.readings.exact.certainty import outward_margin
from cratous.core.readings.graph import program
from cratous.core.readings.graph.nodes import Node, Program, Record, Value, leaves
from cratous.core.readings.machine.compiled import ENCLOSED, Reading, checked
from cratous.core.readings.machine.domain import nonnegative, refuse_negative
from cratous.spec.errors import BadInput

SHARE = 2.0**-51
"""Four units of rounding: one of the operation, the others for the widening in doubles."""
LEAST = 2.0**-1071


@dataclass
class Interval:
    """Arrays low <= real value <= high; doubts: where a division or root may be undefined.

    For truth values low is `surely true` and high `possibly true`.
    """

    low: Any
    high: Any
    doubts: dict[int, Any] = field(default_factory=dict)


def _down(value: Any) -> Any:
    moved = value - outward_margin(value, SHARE, LEAST)
    return np.where(np.isfinite(moved), moved, -np.inf)


def _up(value: Any) -> Any:
    moved = value + outward_margin(value, SHARE, LEAST)
    return np.where(np.isfinite(moved), moved, np.inf)


def _product(a: Interval, b: Interval) -> tuple[Any, Any]:
    corners = [x * y for x in (a.low, a.high) for y in (b.low, b.high)]
    corners = [np.where(np.isnan(c), 0.0, c) for c in corners]  # 0 times infinity: 0 at the corner
    low, high = functools.reduce(np.minimum, corners), functools.reduce(np.maximum, corners)
    return _down(low), _up(high)


def _quotient(a: Interval, b: Interval) -> tuple[Any, Any, Any]:
    doubt = (b.low <= 0) & (b.high >= 0)
    corners = [x / y for x in (a.low, a.high) for y in (b.low, b.high)]
    bad = doubt | functools.reduce(np.logical_or, [np.isnan(c) for c in corners])
    low, high = functools.reduce(np.minimum, corners), functools.reduce(np.maximum, corners)
    return np.where(bad, -np.inf, _down(low)), np.where(bad, np.inf, _up(high)), doubt


def known_by(condition: Node, holds: bool) -> set[tuple[str, int]]:
    """What a condition implies for single values: ("div", n) n is not 0, ("sqrt", n) n is not below 0.

    n are node numbers; holds: whether the condition is true or false.
    """
    if condition.op == "not":
        return known_by(condition.args[0], not holds)
    if condition.op == ("and" if holds else "or"):
        return known_by(condition.args[0], holds) | known_by(condition.args[1], holds)
    opposite = {"lt": "ge", "le": "gt", "gt": "le", "ge": "lt", "eq": "ne", "ne": "eq"}
    if condition.op not in opposite:
        return set()
    op = condition.op if holds else opposite[condition.op]
    a, b = condition.args
    if a.op == "lit":
        a, b = b, a
        op = {"lt": "gt", "le": "ge", "gt": "lt", "ge": "le"}.get(op, op)
    if b.op != "lit" or b.value != 0:
        return set()
    found = {("div", a.number)} if op in ("lt", "gt", "ne") else set()
    return found | ({("sqrt", a.number)} if op in ("gt", "ge") else set())


class _Evaluation:
    """One pass over a graph on arrays of one length."""

    def __init__(self, source: Program, columns: list[Any]) -> None:
        self.made: dict[int, Interval] = {}
        self.operations: dict[int, tuple[str, int]] = {}
        for column, value in zip(source.columns, columns, strict=True):
            self.made[column.number] = Interval(value, value)
        for node in source.nodes:
            if node.number not in self.made:
                self.made[node.number] = self.value(node)

    def value(self, node: Node) -> Interval:
        if node.op == "lit":
            return Interval(np.asarray(node.value), np.asarray(node.value))
        args = [self.made[arg.number] for arg in node.args]
        if node.op == "if":
            return self.chosen(node, *args)
        doubts: dict[int, Any] = {}
        for arg in args:
            for key, mask in arg.doubts.items():
                doubts[key] = doubts[key] | mask if key in doubts else mask
        if node.op == "div":
            low, high, doubt = _quotient(*args)
            return Interval(low, high, self.doubted(node, 1, doubt, doubts))
        if node.op == "sqrt":
            low = _down(np.sqrt(np.maximum(args[0].low, 0.0)))
            high = _up(np.sqrt(np.maximum(args[0].high, 0.0)))
            found = self.doubted(node, 0, args[0].low < 0, doubts)
            return Interval(np.maximum(low, 0.0), high, found)
        if node.op in ("and", "or", "not", "xor"):
            return Interval(*self.logic(node.op, args), self.short(node, args, doubts))
        if node.kind == "int":
            whole = self.whole(node.op, [a.low for a in args])
            return Interval(whole, whole, doubts)
        if node.kind == "bool":
            return Interval(*self.compared(node.op, *args), doubts)
        return Interval(*self.plain(node.op, args), doubts)

    def doubted(self, node: Node, which: int, mask: Any, doubts: dict[int, Any]) -> dict[int, Any]:
        self.operations[node.number] = (node.op, node.args[which].number)
        return {**doubts, node.number: mask}

    def plain(self, op: str, args: list[Interval]) -> tuple[Any, Any]:
        a = args[0]
        if op == "neg":
            return -a.high, -a.low
        if op == "abs":
            least = np.where((a.low <= 0) & (a.high >= 0), 0.0, np.minimum(abs(a.low), abs(a.high)))
            return least, np.maximum(abs(a.low), abs(a.high))
        b = args[1]
        if op == "add":
            return _down(a.low + b.low), _up(a.high + b.high)
        if op == "sub":
            return _down(a.low - b.high), _up(a.high - b.low)
        if op == "mul":
            return _product(a, b)
        which = np.minimum if op == "min" else np.maximum
        return which(a.low, b.low), which(a.high, b.high)

    def whole(self, op: str, args: list[Any]) -> Any:
        table: dict[str, Callable[..., Any]] = {
            "add": np.add,
            "sub": np.subtract,
            "mul": np.multiply,
            "neg": np.negative,
            "abs": np.abs,
            "min": np.minimum,
            "max": np.maximum,
            "bitand": np.bitwise_and,
            "bitor": np.bitwise_or,
        }
        return table[op](*args)

    def compared(self, op: str, a: Interval, b: Interval) -> tuple[Any, Any]:
        if op in ("gt", "ge"):
            a, b, op = b, a, {"gt": "lt", "ge": "le"}[op]
        if op == "lt":
            return a.high < b.low, a.low < b.high
        if op == "le":
            return a.high <= b.low, a.low <= b.high
        same = (a.low == a.high) & (b.low == b.high) & (a.low == b.low)
        meet = (a.low <= b.high) & (b.low <= a.high)
        return (same, meet) if op == "eq" else (~meet, ~same)

    def logic(self, op: str, args: list[Interval]) -> tuple[Any, Any]:
        a = args[0]
        if op == "not":
            return np.logical_not(a.high), np.logical_not(a.low)
        b = args[1]
        if op == "and":
            return a.low & b.low, a.high & b.high
        if op == "or":
            return a.low | b.low, a.high | b.high
        differ = (a.low & ~b.high) | (b.low & ~a.high)
        alike = (a.low & b.low) | (~a.high & ~b.high)
        return differ, ~alike

    def short(self, node: Node, args: list[Interval], doubts: dict[int, Any]) -> dict[int, Any]:
        """`and` and `or` do not evaluate their second operand where the first one decides."""
        if node.op not in ("and", "or"):
            return doubts
        first, second = args
        asked = first.high if node.op == "and" else np.logical_not(first.low)
        return self.joined(
            first.doubts, self.guarded(second.doubts, node.args[0], node.op == "and", asked)
        )

    def guarded(
        self, doubts: dict[int, Any], condition: Node, holds: bool, reached: Any
    ) -> dict[int, Any]:
        """What remains doubtful behind a condition, for states that may get there."""
        known = known_by(condition, holds)
        return {k: m & reached for k, m in doubts.items() if self.operations[k] not in known}

    def joined(self, one: dict[int, Any], other: dict[int, Any]) -> dict[int, Any]:
        found = dict(one)
        for key, mask in other.items():
            found[key] = found[key] | mask if key in found else mask
        return found

    def chosen(self, node: Node, condition: Interval, a: Interval, b: Interval) -> Interval:
        surely, possibly = condition.low, condition.high
        if node.kind == "int":
            if np.any(surely != possibly):
                raise BadInput(
                    "a whole number depends on a condition that rounding leaves open",
                    item=f"[{int(np.flatnonzero(np.atleast_1d(surely != possibly))[0])}]",
                )
            return Interval(*[np.where(surely, a.low, b.low)] * 2)
        low = np.where(surely, a.low, np.where(possibly, np.minimum(a.low, b.low), b.low))
        high = np.where(surely, a.high, np.where(possibly, np.maximum(a.high, b.high), b.high))
        test = node.args[0]
        doubts = self.joined(
            condition.doubts,
            self.joined(
                self.guarded(a.doubts, test, True, possibly),
                self.guarded(b.doubts, test, False, np.logical_not(surely)),
            ),
        )
        return Interval(low, high, doubts)


def enclosed(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """The enclosed reading of a kernel over arrays.

    Takes columns as `compiled(kernel)` does. A real result comes as a pair (low, high) of arrays
    that contain the kernel's value on the reals that the columns are; a truth value as a pair
    (surely, possibly); a record as a record of these. Raises BadInput, with column or index, for
    input that is not finite, where the kernel is not surely defined, and where there is no finite
    enclosure.
    """
    source = program(kernel)
    names = nonnegative(kernel)

    def run(*columns: Any) -> Any:
        flat, shape = checked(source, columns)
        refuse_negative(source.name, names, zip(source.labels, flat, strict=True))
        for label, value in zip(source.labels, flat, strict=True):
            wrong = np.flatnonzero(~np.isfinite(np.atleast_1d(value)))
            if wrong.size:
                item = f"{label}[{wrong[0]}]" if np.ndim(value) else label
                got = str(np.atleast_1d(value)[wrong[0]])
                raise BadInput(
                    "is not finite", where=source.name, item=item, expected="a number", got=got
                )
        with np.errstate(all="ignore"):
            done = _Evaluation(source, flat)
        size = math.prod(shape)
        for leaf in leaves(source.result):
            _refuse(source, done, leaf, size)
        return _built(source.result, done, size, shape)

    return Reading(kernel, ENCLOSED, run)


def _refuse(source: Program, done: _Evaluation, leaf: Node, size: int) -> None:
    found = done.made[leaf.number]
    for key, mask in found.doubts.items():
        wrong = np.flatnonzero(np.broadcast_to(mask, size))
        if wrong.size:
            reasons = {
                "div": "divides by what may be 0",
                "sqrt": "takes a root of what may be negative",
            }
            raise BadInput(
                reasons[done.operations[key][0]], where=source.name, item=f"[{wrong[0]}]"
            )
    if leaf.kind == "float":
        width = np.broadcast_to(np.isfinite(found.low) & np.isfinite(found.high), size)
        wrong = np.flatnonzero(~width)
        if wrong.size:
            what = "has no finite enclosure"
            raise BadInput(what, where=source.name, item=f"[{wrong[0]}]")


def _built(shape: Value, done: _Evaluation, size: int, dimensions: tuple[int, ...]) -> Any:
    if isinstance(shape, Record):
        return shape.kind(*[_built(f, done, size, dimensions) for f in shape.fields])
    found = done.made[shape.number]
    return tuple(
        np.broadcast_to(side, size).reshape(dimensions) for side in (found.low, found.high)
    )
