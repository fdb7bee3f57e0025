"""The last stage of the exact reading: the kernel's graph on integers with tracked exponents.

Every finite double is m * 2^e with integers m and e. Products multiply the m and add the e; sums shift one m to the
lesser e. There is no range limit and no rounding. Verdicts are written with short circuit, as functions of the
columns' (m, e).
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

from cratous.core.readings.graph.nodes import Node, Program, leaves, ordered
from cratous.core.readings.graph.printing import name


def pair(value: float) -> tuple[int, int]:
    """(m, e) with value = m * 2^e; value is finite."""
    fraction, exponent = math.frexp(value)
    mantissa = int(fraction * 9007199254740992.0)
    return (mantissa, exponent - 53) if mantissa else (0, 0)


def add(m: int, e: int, n: int, f: int) -> tuple[int, int]:
    """m 2^e + n 2^f."""
    if e <= f:
        return m + (n << (f - e)), e
    return (m << (e - f)) + n, f


def sign(m: int, e: int, n: int, f: int) -> int:
    """The sign of m 2^e - n 2^f."""
    gap = m - (n << (f - e)) if e <= f else (m << (e - f)) - n
    return (gap > 0) - (gap < 0)


WORDS = {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "==", "ne": "!="}


class _Writer:
    """Text of one function: real values on demand, each at most once, as nested functions."""

    def __init__(self, source: Program) -> None:
        self.source = source
        self.columns = ", ".join(str(c.value) for c in source.columns)
        self.functions: dict[str, list[str]] = {}

    def value(self, node: Node) -> str:
        """Text of an integer or truth value."""
        if node.op in ("in", "lit"):
            return name(node)
        if node.op == "not":
            return f"(not {self.value(node.args[0])})"
        if node.op in ("and", "or", "xor"):
            label = f"b{node.number}"
            if label not in self.functions:
                self.functions[label] = []
                a, b = (self.value(arg) for arg in node.args)
                word = {"and": "and", "or": "or", "xor": "!="}[node.op]
                self.functions[label] = [f"    return {a} {word} {b}"]
            return f"{label}({self.columns})"
        if node.op in WORDS and node.args[0].kind == "float":
            return f"({self.compared(*node.args)} {WORDS[node.op]} 0)"
        args = [self.value(arg) for arg in node.args]
        if node.op in WORDS:
            return f"({args[0]} {WORDS[node.op]} {args[1]})"
        if node.op == "if":
            return f"({args[1]} if {args[0]} else {args[2]})"
        if node.op in ("abs", "min", "max"):
            return f"{node.op}({', '.join(args)})"
        if node.op == "neg":
            return f"(-{args[0]})"
        word = {"add": "+", "sub": "-", "mul": "*", "bitand": "&", "bitor": "|"}[node.op]
        return f"({args[0]} {word} {args[1]})"

    def compared(self, a: Node, b: Node) -> str:
        """Text of the sign of a - b; a function of its own, so that it is computed on demand."""
        label = f"c{a.number}_{b.number}"
        if label not in self.functions:
            self.functions[label] = []
            lines = [line for part in ordered([a, b]) for line in self.real(part)]
            last = f"    return sign({self.both(a)}, {self.both(b)})"
            self.functions[label] = [*lines, last]
        return f"{label}({self.columns})"

    def both(self, node: Node) -> str:
        return f"m{node.number}, e{node.number}"

    def real(self, node: Node) -> list[str]:
        """Lines that compute (m, e) of one real value from those of its operands."""
        if node.kind != "float":
            return []
        left = f"    {self.both(node)} = "
        if node.op == "in":
            return [left + str(node.value)]
        if node.op == "lit":
            return [left + f"{int(node.value)}, 0"]
        if node.op == "if":
            test = self.value(node.args[0])
            a, b = (self.both(arg) for arg in node.args[1:])
            return [f"{left}({a}) if {test} else ({b})"]
        args = [self.both(arg) for arg in node.args]
        n = [arg.number for arg in node.args]
        if node.op == "add":
            return [f"{left}add({args[0]}, {args[1]})"]
        if node.op == "sub":
            return [f"{left}add({args[0]}, -m{n[1]}, e{n[1]})"]
        if node.op == "mul":
            return [f"{left}m{n[0]} * m{n[1]}, e{n[0]} + e{n[1]}"]
        if node.op in ("neg", "abs"):
            return [
                f"{left}{'-' if node.op == 'neg' else ''}"
                + (f"abs(m{n[0]})" if node.op == "abs" else f"m{n[0]}")
                + f", e{n[0]}"
            ]
        word = "<=" if node.op == "min" else ">="
        return [f"{left}({args[0]}) if sign({args[0]}, {args[1]}) {word} 0 else ({args[1]})"]


def text(source: Program) -> str:
    """The module's text: `verdict(columns...)` gives the tuple of results.

    Real columns and real results are represented as (m, e).
    """
    writer = _Writer(source)
    lines, results = [], []
    for leaf in leaves(source.result):
        if leaf.kind == "float":
            lines += [line for part in ordered([leaf]) for line in writer.real(part)]
            results.append(f"({writer.both(leaf)})")
        else:
            results.append(writer.value(leaf))
    lines = list(dict.fromkeys(lines))
    lines.append(f"    return ({', '.join(results)},)")
    writer.functions["verdict"] = lines
    heads = [f"def {label}({writer.columns}):" for label in writer.functions]
    bodies = ["\n".join(body) for body in writer.functions.values()]
    return "\n\n\n".join(f"{h}\n{b}" for h, b in zip(heads, bodies, strict=True)) + "\n"


@functools.cache
def decider(source: Program) -> Callable[..., tuple[Any, ...]]:
    """`verdict` of the text, run by CPython."""
    scope: dict[str, Any] = {"add": add, "sign": sign}
    exec(compile(text(source), f"<{source.name} on integers>", "exec"), scope)
    found: Callable[..., tuple[Any, ...]] = scope["verdict"]
    return found
