"""The third stage of the exact reading: exact signs by floating-point expansions, compiled.

For each comparison of a kernel that rounding could decide wrongly this module writes a function,
which asks the filter first, pairs of doubles next (`pairs`) and residues then (`residues`), and a
table of steps on expansions (`expansion_steps`), which one compiled function carries out for all
kernels (`expansion_arithmetic`). Verdicts are short-circuited, so only what matters is computed: a
verdict is evaluated with the signs known so far, and again with each that turns out to be missing.
The known signs are in the work array beside the numbers (2: not known), and so is the number of the
first one missing (-1: none), so that one array alone is handed from function to function.

Range: every real input is 0 or has a magnitude in [2^-E, 2^E]. E is the greatest number up to 100
for which every value of the graph is a multiple of 2^-960 (so that not even a share of one part
of it underflows) and stays below 2^990; outside of it the generated function answers UNDECIDED.
"""

from __future__ import annotations

from cratous.core.readings.exact import residues
from cratous.core.readings.exact.double_pairs import MOST_LINES, NAMES
from cratous.core.readings.exact.double_pairs import Writer as Pairs
from cratous.core.readings.exact.expansion_arithmetic import TIMES
from cratous.core.readings.exact.expansion_steps import Layout, Steps
from cratous.core.readings.exact.float_filter import UNDECIDED, Filter
from cratous.core.readings.graph.nodes import Node, ordered
from cratous.core.readings.graph.printing import name, straight

MOST_CELLS = 200_000


def reach(nodes: list[Node]) -> int:
    """The exponent E of the module's docstring for these nodes; 0 if there is no useful one."""
    for exponent in range(100, 15, -1):
        grid: dict[int, int] = {}
        top: dict[int, int] = {}
        for node in nodes:
            if node.kind != "float":
                continue
            args = [arg.number for arg in node.args if arg.kind == "float"]
            if node.op == "in":
                grid[node.number], top[node.number] = exponent + 52, exponent
            elif node.op == "lit":
                grid[node.number], top[node.number] = 0, int(abs(node.value)).bit_length()
            elif node.op == "mul":
                grid[node.number] = sum(grid[a] for a in args)
                top[node.number] = sum(top[a] for a in args)
            else:
                grid[node.number] = max(grid[a] for a in args)
                top[node.number] = max(top[a] for a in args) + 1
        if all(g <= 960 for g in grid.values()) and all(t <= 990 for t in top.values()):
            return exponent
    return 0


class Writer:
    """Writes the code that decides one filtered kernel: functions, steps, and the layout of the array."""

    def __init__(self, found: Filter, pairs: bool = True) -> None:
        self.program = found.program
        self.paired_lines = MOST_LINES if pairs else 0
        self.columns = ", ".join(str(column.value) for column in self.program.columns)
        self.compared_nodes = found.compared
        self.certain = {node.number: certain for node, certain in found.states}
        self.functions: dict[str, list[str]] = {}
        self.steps: list[tuple[int, ...]] = []
        self.spans: list[tuple[int, int]] = []
        self.reach = reach(self.program.nodes)
        self.layout = Layout(self.program.nodes, len(found.compared))
        self.cells = self.layout.base

    @property
    def possible(self) -> bool:
        """True iff there is a range and the work array stays small."""
        return self.reach > 0 and self.cells <= MOST_CELLS

    def sign(self, number: int) -> str:
        """Location of the sign of one comparison."""
        return f"w[{self.layout.known + number}]"

    @property
    def want(self) -> str:
        """Location of the number of the comparison whose sign is missing first."""
        return f"w[{self.layout.want}]"

    # -- truth values and integers ------------------------------------------------------
    def truth(self, node: Node) -> str:
        """Text that evaluates a truth value of the kernel's graph, with short circuit."""
        if node.op in ("in", "lit"):
            return name(node)
        if node.op == "not":
            return f"(not {self.truth(node.args[0])})"
        if node.op in ("and", "or", "xor"):
            label = f"b{node.number}"
            if label not in self.functions:
                self.functions[label] = []
                a, b = (self.truth(arg) for arg in node.args)
                word = {"and": "and", "or": "or", "xor": "!="}[node.op]
                self.define(label, [f"    return {a} {word} {b}"])
            return f"{label}(w, {self.columns})"
        sign = {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "==", "ne": "!="}[node.op]
        if self.certain[node.number].sharp:
            a, b = (self.plain(arg) for arg in node.args)
            return f"({a} {sign} {b})"
        return f"({self.compared(node)} {sign} 0)"

    def plain(self, node: Node) -> str:
        """Text of a value that is exact on doubles, or of an integer."""
        if node.op in ("in", "lit"):
            return name(node)
        if node.op == "if":
            a, b = (self.plain(arg) for arg in node.args[1:])
            return f"({a} if {self.truth(node.args[0])} else {b})"
        args = [self.plain(arg) for arg in node.args]
        if node.op == "neg":
            return f"(-{args[0]})"
        if node.op == "abs":
            return f"abs({args[0]})"
        if node.op in ("min", "max"):
            sign = "<" if node.op == "min" else ">"
            return f"({args[1]} if {args[1]} {sign} {args[0]} else {args[0]})"
        word = {"add": "+", "sub": "-", "mul": "*", "bitand": "&", "bitor": "|"}[node.op]
        return f"({args[0]} {word} {args[1]})"

    def define(self, label: str, lines: list[str]) -> None:
        """Add a function; callees come first because they are defined first."""
        self.functions.pop(label, None)
        head = f"@FLAGS\ndef {label}(w, {self.columns}):"
        self.functions[label] = [head, *lines]

    # -- comparisons --------------------------------------------------------------------
    def compared(self, node: Node) -> str:
        """Text of the sign of the difference of the node's operands."""
        label = f"c{node.args[0].number}_{node.args[1].number}"
        if label not in self.functions:
            self.functions[label] = []
            lines = self.second(*node.args)
            number = len(self.spans) - 1
            sign = self.sign(number)
            known = [f"    if {sign} != 2:", f"        return {sign}"]
            ask = [f"    if {self.want} < 0:", f"        {self.want} = {number}", "    return 0.0"]
            sooner = [*self.first(node, number), *self.paired(node, number)]
            self.define(label, [*known, *sooner, *lines, *ask])
        return f"{label}(w, {self.columns})"

    def first(self, node: Node, number: int) -> list[str]:
        """The filter of one comparison, unless a value in it depends on an uncertain one."""
        for part in ordered(list(node.args)):
            if part.op == "if" and not self.certain[part.args[0].number].sharp:
                return []
        found = next(c for c in self.compared_nodes if c.original is node)
        roots = [root for root in (found.above, found.below) if root is not None]
        lines = straight([arg for root in roots for arg in root.args], "    ")
        for root in roots:
            word, sign = (">", 1.0) if root.op == "gt" else ("<", -1.0)
            lines.append(f"    if {name(root.args[0])} {word} {name(root.args[1])}:")
            lines.append(f"        {self.sign(number)} = {sign}")
            lines.append(f"        return {sign}")
        return lines

    def paired(self, node: Node, number: int) -> list[str]:
        """The sign by pairs of doubles and by residues; [] if the kernel has too many such lines."""
        pairs = Pairs()
        parts = [part for part in ordered(list(node.args)) if part.kind == "float"]
        for part in parts:
            if part.op == "if":
                pairs.lines.append(f"    t{part.number} = {self.truth(part.args[0])}")
                if not self.certain[part.args[0].number].sharp:
                    # another sign is missing on which this one depends
                    pairs.lines += [f"    if {self.want} >= 0:", "        return 0.0"]
            pairs.value(part)
        a, b = node.args
        high = pairs.sign(a, b, self.sign(number))
        found = [*pairs.lines, *residues.lines(parts, a, b, high, "bound", self.sign(number))]
        if len(found) > self.paired_lines:
            return []
        self.paired_lines -= len(found)
        return found

    def second(self, a: Node, b: Node) -> list[str]:
        """The steps to the sign of a - b; returns lines that set conditions for them."""
        body = Steps(self.layout)
        lines = []
        for part in (n for n in ordered([a, b]) if n.kind == "float"):
            if part.op == "if":
                place = self.layout.fix(f"d{part.number}").place
                truth = self.truth(part.args[0])
                lines.append(f"    w[{place}] = -1.0 if {truth} else 1.0")
        first = len(self.steps)
        x, y = body.cell(a), body.cell(b)
        if b.op == "lit" and b.value == 0:
            body.step(TIMES, x, self.layout.fix("1.0"), x.longest)
        else:
            body.sum(x, y, -1)
        self.steps += body.steps
        self.cells = max(self.cells, body.free)
        self.spans.append((first, len(self.steps)))
        return lines


def text(
    found: Filter, scalars: frozenset[str], flags: str, shared: str, pairs: bool = True
) -> tuple[str, int, int] | None:
    """A module with `_map(out, code, index, w, length, columns...)`; its cells and values.

    It decides the states whose numbers stand in `index` and writes into `out`, or UNDECIDED into
    `code` where an input is out of range; columns named in `scalars` are single values. shared:
    name of the module of what all kernels share. pairs: False leaves them out, for tests. None
    where the kernel has no range, or would need too large a work array.
    """
    writer = Writer(found, pairs)
    result = found.program.result
    if not isinstance(result, Node):
        return None
    verdict = writer.truth(result) if result.kind == "bool" else writer.plain(result)
    if not writer.possible:
        return None
    columns = found.program.columns
    low, high = 2.0**-writer.reach, 2.0**writer.reach
    usable = [
        f"usable({column.value}, {low!r}, {high!r})" for column in columns if column.kind == "float"
    ]
    source_columns = [c for c in columns if name(c) in writer.layout.fixed]
    arguments = ", ".join(str(c.value) if c.value in scalars else f"a_{c.value}" for c in columns)
    literals = [(t, c) for t, c in writer.layout.fixed.items() if t[0] in "-0123456789("]
    body = [
        f"@FLAGS\ndef _map(out, code, index, w, length, {arguments}):",
        *[f"    w[{cell.place}] = {literal}" for literal, cell in literals],
        "    for j in range(index.size):",
        "        i = index[j]",
        *[
            f"        {column.value} = a_{column.value}[i]"
            for column in columns
            if column.value not in scalars
        ],
        f"        if not ({' and '.join(usable) or 'True'}):",
        f"            code[i] = {UNDECIDED}",
        "            continue",
        *[
            f"        w[{writer.layout.fix(name(column)).place}] = {name(column)}"
            for column in source_columns
        ],
        *[f"        {writer.sign(k)} = 2.0" for k in range(len(writer.spans))],
        "        while True:",
        "            # with the signs known so far; then the one that was missed first",
        f"            {writer.want} = -1.0",
        f"            verdict = {verdict}",
        f"            if {writer.want} < 0:",
        "                break",
        f"            k = int({writer.want})",
        "            sign = sign_of(w, length, STEPS, SPANS[k, 0], SPANS[k, 1])",
        f"            w[{writer.layout.known} + k] = sign",
        "        out[i] = verdict",
    ]
    spans = [list(span) for span in writer.spans] or [[0, 0]]
    rows = ",\n".join(f"        {list(step)}" for step in writer.steps) or f"        {[0] * 9}"
    head = (
        f"import numpy as np\nfrom numba import njit\n\nfrom {shared} import (\n"
        f"    sign_of, usable, {NAMES},\n    {residues.NAMES}\n)\n\n"
        f"STEPS = np.array(\n    [\n{rows},\n    ],\n    dtype=np.int32,\n)\n"
        f"SPANS = np.array({spans}, dtype=np.int32)"
    )
    parts = [head, *("\n".join(lines) for lines in writer.functions.values()), "\n".join(body)]
    joined = "\n\n\n".join(parts).replace("@FLAGS", f"@{flags}") + "\n"
    return joined, writer.cells, writer.layout.values
