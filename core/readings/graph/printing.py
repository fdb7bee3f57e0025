"""Graphs as straight-line Python text, for CPython and numba alike.

min and max are written as CPython defines them (the first operand unless the second is strictly less, or greater), so
that signed zeros and NaN give the same result in both.
"""

from __future__ import annotations

from cratous.core.readings.graph.nodes import Node, ordered

INFIX = {
    "add": "+",
    "sub": "-",
    "mul": "*",
    "div": "/",
    "lt": "<",
    "le": "<=",
    "gt": ">",
    "ge": ">=",
    "eq": "==",
    "ne": "!=",
    "and": "&",
    "or": "|",
    "xor": "!=",
    "bitand": "&",
    "bitor": "|",
}


def name(node: Node) -> str:
    """The text for a node: its column, its literal, or its variable."""
    if node.op == "in":
        return str(node.value)
    if node.op == "lit":
        text = repr(node.value)
        return f"({text})" if text.startswith("-") else text
    return f"n{node.number}"


def expression(node: Node) -> str:
    """The operation of one node on its operands' names."""
    args = [name(arg) for arg in node.args]
    if node.op in INFIX:
        return f"{args[0]} {INFIX[node.op]} {args[1]}"
    if node.op == "neg":
        return f"-{args[0]}"
    if node.op == "not":
        return f"not {args[0]}"
    if node.op == "if":
        return f"{args[1]} if {args[0]} else {args[2]}"
    if node.op in ("min", "max"):
        sign = "<" if node.op == "min" else ">"
        return f"{args[1]} if {args[1]} {sign} {args[0]} else {args[0]}"
    return f"{node.op}({', '.join(args)})"


def straight(roots: list[Node], indent: str) -> list[str]:
    """Assignments, one for each operation that the roots need, operands first."""
    return [
        f"{indent}{name(node)} = {expression(node)}"
        for node in ordered(roots)
        if node.op not in ("in", "lit")
    ]
