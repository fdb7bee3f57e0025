"""The second stage of the exact reading: exact signs by floating-point expansions, compiled.

An expansion is a sum of doubles of which no two overlap; sums and products of expansions are
exact as long as nothing overflows or underflows (J. R. Shewchuk, "Adaptive Precision
Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997; products split after Dekker,
so that no fused operation is needed). For each comparison of a kernel that rounding could decide
wrongly this module writes a function, which asks the filter first, and a table of steps over a
work array with fixed places, which one compiled function carries out for all kernels. Verdicts
are short-circuited, so only what matters is computed: a verdict is evaluated with the signs known
so far, and again with each that turns out to be missing.

Range: every real input is 0 or has a magnitude in [2^-E, 2^E]. E is the greatest number up to 100
for which every value of the graph is a multiple of 2^-1074 and stays below 2^990; outside of it
the generated function answers UNDECIDED.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from cratous.core.filtering import UNDECIDED, Filter
from cratous.core.graph import Node, ordered
from cratous.core.printing import name, straight

MOST_CELLS = 200_000
LONGEST = 2100
"""No expansion is longer: its parts do not overlap, and doubles span fewer bits."""
MUL2, ADD2, SUB2, ADD, SUB, SCALE, MUL, TIMES, ABS, PICK, PICK_NOT, DOT, CROSS = range(13)

PRIMITIVES = '''
# An expansion's place has two cells more than it is long: results are written before it is known
# whether they are zero, and no branch depends on the data.
@FLAGS
def _add2(w, c, x, y):
    """x + y."""
    s = x + y
    t = s - x
    e = (x - (s - t)) + (y - t)
    w[c] = e
    n = 1 if e != 0 else 0
    w[c + n] = s
    return n + (1 if s != 0 else 0)


@FLAGS
def _high(x):
    """The upper 26 bits of x (Dekker)."""
    t = 134217729.0 * x
    return t - (t - x)


@FLAGS
def _mul2(w, c, x, y):
    """x * y."""
    p = x * y
    a = _high(x)
    b = x - a
    d = _high(y)
    f = y - d
    e = b * f - (((p - a * d) - b * d) - a * f)
    w[c] = e
    n = 1 if e != 0 else 0
    w[c + n] = p
    return n + (1 if p != 0 else 0)


@FLAGS
def _dot(w, c, x, y, u, v, sign):
    """x * y plus sign times u * v: a sum of two and two, without a loop."""
    p = x * y
    a = _high(x)
    b = x - a
    d = _high(y)
    f = y - d
    e = b * f - (((p - a * d) - b * d) - a * f)
    q = sign * (u * v)
    a = _high(u)
    b = u - a
    d = _high(v)
    f = v - d
    g = sign * (b * f - (((sign * q - a * d) - b * d) - a * f))
    s = e + g
    t = s - e
    h0 = (e - (s - t)) + (g - t)
    i = p + s
    t = i - p
    k = (p - (i - t)) + (s - t)
    s = k + q
    t = s - k
    h1 = (k - (s - t)) + (q - t)
    h3 = i + s
    t = h3 - i
    h2 = (i - (h3 - t)) + (s - t)
    w[c] = h0
    n = 1 if h0 != 0 else 0
    w[c + n] = h1
    n += 1 if h1 != 0 else 0
    w[c + n] = h2
    n += 1 if h2 != 0 else 0
    w[c + n] = h3
    return n + (1 if h3 != 0 else 0)


@FLAGS
def _times(w, a, n, x, c):
    """The expansion at a times x, a power of two or 0 or -1."""
    if x == 0:
        return 0
    for k in range(n):
        w[c + k] = w[a + k] * x
    return n


@FLAGS
def _scale(w, a, n, y, c):
    """The expansion at a times y."""
    if n == 0 or y == 0:
        return 0
    d = _high(y)
    f = y - d
    m = 0
    q = 0.0
    for k in range(n):
        x = w[a + k]
        p = x * y
        g = _high(x)
        h = x - g
        low = h * f - (((p - g * d) - h * d) - g * f)
        if k == 0:
            q = p
            w[c] = low
            m = 1 if low != 0 else 0
        else:
            s = q + low
            t = s - q
            e = (q - (s - t)) + (low - t)
            w[c + m] = e
            m += 1 if e != 0 else 0
            q = p + s
            e = s - (q - p)
            w[c + m] = e
            m += 1 if e != 0 else 0
    w[c + m] = q
    m += 1 if q != 0 else 0
    return m


@FLAGS
def _sum(w, a, n, b, k, sign, c):
    """The expansion at a plus sign times the one at b."""
    if n == 0:
        return _times(w, b, k, sign, c)
    if k == 0:
        return _times(w, a, n, 1.0, c)
    i = 0
    j = 0
    m = 0
    q = 0.0
    for _ in range(n + k):
        # one place beyond either may be read: it is not used
        x = w[a + i]
        y = w[b + j]
        first = (j == k) | ((i < n) & (abs(x) < abs(y)))
        x = x if first else sign * y
        i += 1 if first else 0
        j += 0 if first else 1
        s = q + x
        t = s - q
        e = (q - (s - t)) + (x - t)
        w[c + m] = e
        m += 1 if e != 0 else 0
        q = s
    w[c + m] = q
    m += 1 if q != 0 else 0
    return m


@FLAGS
def _mul(w, a, n, b, k, c, t, u):
    """The product of two expansions; t and u are scratch."""
    if n < k:
        a, n, b, k = b, k, a, n
    if k == 0:
        return 0
    m = _scale(w, a, n, w[b], c)
    for j in range(1, k):
        p = _scale(w, a, n, w[b + j], t)
        r = _sum(w, c, m, t, p, 1.0, u)
        m = _times(w, u, r, 1.0, c)
    return m


@FLAGS
def _sign(w, a, n):
    """The sign of an expansion: that of its greatest part."""
    if n == 0 or w[a + n - 1] == 0:
        return 0
    return 1 if w[a + n - 1] > 0 else -1


@FLAGS
def sign_of(w, length, steps, first, last):
    """Carry out the steps first to last - 1 and give the sign of the last one's result.

    A step is (operation, operands x and y, result z, their places in w, two scratch places);
    length[x] is the length of value x.
    """
    z = 0
    at = 0
    for k in range(first, last):
        op = steps[k, 0]
        x = steps[k, 1]
        y = steps[k, 2]
        z = steps[k, 3]
        a = steps[k, 4]
        b = steps[k, 5]
        at = steps[k, 6]
        if op == 0:
            length[z] = _mul2(w, at, w[a], w[b])
        elif op == 1:
            length[z] = _add2(w, at, w[a], w[b])
        elif op == 2:
            length[z] = _add2(w, at, w[a], -w[b])
        elif op == 3:
            length[z] = _sum(w, a, length[x], b, length[y], 1.0, at)
        elif op == 4:
            length[z] = _sum(w, a, length[x], b, length[y], -1.0, at)
        elif op == 5:
            length[z] = _scale(w, a, length[x], w[b], at)
        elif op == 6:
            length[z] = _mul(w, a, length[x], b, length[y], at, steps[k, 7], steps[k, 8])
        elif op == 7:
            length[z] = _times(w, a, length[x], w[b], at)
        elif op == 8:
            length[z] = _times(w, a, length[x], 1.0 * _sign(w, a, length[x]), at)
        elif op == 11:
            length[z] = _dot(w, at, w[a], w[b], w[steps[k, 7]], w[steps[k, 8]], 1.0)
        elif op == 12:
            length[z] = _dot(w, at, w[a], w[b], w[steps[k, 7]], w[steps[k, 8]], -1.0)
        else:
            # the first operand where the sign of value p is not s, else the second
            p = steps[k, 7]
            if _sign(w, steps[k, 8], length[p]) * (1 if op == 9 else -1) <= 0:
                length[z] = _times(w, a, length[x], 1.0, at)
            else:
                length[z] = _times(w, b, length[y], 1.0, at)
    return _sign(w, at, length[z])


@FLAGS
def usable(x, low, high):
    """True iff x is 0 or of a magnitude from low to high."""
    return x == 0 or (abs(x) >= low and abs(x) <= high)
'''


def reach(nodes: list[Node]) -> int:
    """The exponent E of the module's docstring for these nodes; 0 if there is none of use."""
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
        if all(g <= 1074 for g in grid.values()) and all(t <= 990 for t in top.values()):
            return exponent
    return 0


@dataclass(frozen=True)
class Cell:
    """A value in the work array: its number, its place, its greatest length; one double or more."""

    number: int
    place: int
    longest: int = 1
    double: bool = False


class Writer:
    """Writes what decides one filtered kernel: functions, steps, and the layout of the array."""

    def __init__(self, found: Filter) -> None:
        self.program = found.program
        self.columns = ", ".join(str(column.value) for column in self.program.columns)
        self.compared_nodes = found.compared
        self.certain = {node.number: certain for node, certain in found.states}
        self.functions: dict[str, list[str]] = {}
        self.steps: list[tuple[int, ...]] = []
        self.spans: list[tuple[int, int]] = []
        self.fixed: dict[str, Cell] = {}
        self.constants: list[str] = []
        self.values = 0
        self.reach = reach(self.program.nodes)
        for node in self.program.nodes:
            if node.kind == "float" and node.op in ("in", "lit"):
                self.fix(name(node))
            elif node.kind == "float" and node.op == "if":
                self.fix(f"d{node.number}")
        for sign in ("1.0", "-1.0"):
            self.fix(sign)
        self.base = self.cells = len(self.fixed)

    def fix(self, text: str) -> Cell:
        """The place of a column, literal or condition."""
        if text not in self.fixed:
            self.fixed[text] = Cell(self.values, len(self.fixed), double=True)
            self.values += 1
        return self.fixed[text]

    @property
    def possible(self) -> bool:
        """True iff there is a range and the work array stays small."""
        return self.reach > 0 and self.cells <= MOST_CELLS

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
            return f"{label}(w, known, want, {self.columns})"
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
        head = f"@FLAGS\ndef {label}(w, known, want, {self.columns}):"
        self.functions[label] = [head, *lines]

    # -- comparisons --------------------------------------------------------------------
    def compared(self, node: Node) -> str:
        """Text of the sign of the difference of the node's operands."""
        label = f"c{node.args[0].number}_{node.args[1].number}"
        if label not in self.functions:
            self.functions[label] = []
            lines = self.second(*node.args)
            number = len(self.spans) - 1
            known = [f"    if known[{number}] != 2:", f"        return known[{number}]"]
            ask = ["    if want[0] < 0:", f"        want[0] = {number}", "    return 0"]
            self.define(label, [*known, *self.first(node, number), *lines, *ask])
        return f"{label}(w, known, want, {self.columns})"

    def first(self, node: Node, number: int) -> list[str]:
        """The filter of one comparison, unless a value in it hangs on an uncertain one."""
        for part in ordered(list(node.args)):
            if part.op == "if" and not self.certain[part.args[0].number].sharp:
                return []
        found = next(c for c in self.compared_nodes if c.original is node)
        roots = [root for root in (found.above, found.below) if root is not None]
        lines = straight([arg for root in roots for arg in root.args], "    ")
        for root in roots:
            word, sign = (">", 1) if root.op == "gt" else ("<", -1)
            lines.append(f"    if {name(root.args[0])} {word} {name(root.args[1])}:")
            lines.append(f"        known[{number}] = {sign}")
            lines.append(f"        return {sign}")
        return lines

    def second(self, a: Node, b: Node) -> list[str]:
        """The steps to the sign of a - b; returned are lines that set conditions for them."""
        body = _Body(self)
        lines = []
        for part in (n for n in ordered([a, b]) if n.kind == "float"):
            if part.op == "if":
                place = self.fix(f"d{part.number}").place
                truth = self.truth(part.args[0])
                lines.append(f"    w[{place}] = -1.0 if {truth} else 1.0")
        first = len(self.steps)
        x, y = body.cell(a), body.cell(b)
        if b.op == "lit" and b.value == 0:
            body.step(TIMES, x, self.fix("1.0"), x.longest)
        else:
            body.sum(x, y, -1)
        self.steps += body.steps
        self.cells = max(self.cells, body.free)
        self.spans.append((first, len(self.steps)))
        return lines


class _Body:
    """The steps of one comparison."""

    def __init__(self, writer: Writer) -> None:
        self.writer = writer
        self.steps: list[tuple[int, ...]] = []
        self.made: dict[int, Cell] = {}
        self.free = writer.base

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
        made = Cell(self.writer.values, at, min(longest, LONGEST))
        self.writer.values += 1
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
        writer = self.writer
        if node.op in ("in", "lit"):
            return writer.fix(name(node))
        if node.op in ("add", "sub"):
            made = self.dot(node)
            if made is not None:
                return made
        args = [self.cell(arg) for arg in node.args if arg.kind == "float"]
        x, y = args[0], args[-1]
        longest = max(x.longest, y.longest)
        if node.op == "if":
            condition = writer.fix(f"d{node.number}")
            made = self.step(PICK, x, y, longest, (condition.number, condition.place))
        elif node.op in ("add", "sub"):
            made = self.sum(x, y, 1 if node.op == "add" else -1)
        elif node.op == "mul":
            made = self.doubled(node, args) or self.product(x, y)
        elif node.op in ("neg", "abs"):
            op = TIMES if node.op == "neg" else ABS
            made = self.step(op, x, writer.fix("-1.0"), longest)
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


def primitives(flags: str) -> str:
    """The module that all kernels share: `sign_of` and `usable`."""
    return "from numba import njit\n\n\n" + PRIMITIVES.strip().replace("@FLAGS", f"@{flags}") + "\n"


def text(
    found: Filter, scalars: frozenset[str], flags: str, shared: str
) -> tuple[str, int, int] | None:
    """A module with `_map(out, code, index, w, length, columns...)`; its cells and values.

    It decides the states whose numbers stand in `index` and writes into `out`, or UNDECIDED into
    `code` where an input is out of range; columns named in `scalars` are single values. shared:
    name of the module of `primitives`. None where the kernel has no range, or would need too
    large a work array.
    """
    writer = Writer(found)
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
    source_columns = [c for c in columns if name(c) in writer.fixed]
    arguments = ", ".join(str(c.value) if c.value in scalars else f"a_{c.value}" for c in columns)
    literals = [(t, c) for t, c in writer.fixed.items() if t[0] in "-0123456789("]
    body = [
        f"@FLAGS\ndef _map(out, code, index, w, length, {arguments}):",
        *[f"    w[{cell.place}] = {literal}" for literal, cell in literals],
        f"    known = np.empty({len(writer.spans) + 1}, np.int64)",
        "    want = np.empty(1, np.int64)",
        "    for k in range(index.size):",
        "        i = index[k]",
        *[
            f"        {column.value} = a_{column.value}[i]"
            for column in columns
            if column.value not in scalars
        ],
        f"        if not ({' and '.join(usable) or 'True'}):",
        f"            code[i] = {UNDECIDED}",
        "            continue",
        *[
            f"        w[{writer.fix(name(column)).place}] = {name(column)}"
            for column in source_columns
        ],
        "        known[:] = 2",
        "        while True:",
        "            # with the signs known so far; then the one that was missed first",
        "            want[0] = -1",
        f"            verdict = {verdict}",
        "            if want[0] < 0:",
        "                break",
        "            first, last = SPANS[want[0], 0], SPANS[want[0], 1]",
        "            known[want[0]] = sign_of(w, length, STEPS, first, last)",
        "        out[i] = verdict",
    ]
    spans = [list(span) for span in writer.spans] or [[0, 0]]
    rows = ",\n".join(f"        {list(step)}" for step in writer.steps) or f"        {[0] * 9}"
    head = (
        f"import numpy as np\nfrom numba import njit\n\nfrom {shared} import sign_of, usable\n\n"
        f"STEPS = np.array(\n    [\n{rows},\n    ],\n    dtype=np.int32,\n)\n"
        f"SPANS = np.array({spans}, dtype=np.int32)"
    )
    parts = [head, *("\n".join(lines) for lines in writer.functions.values()), "\n".join(body)]
    joined = "\n\n\n".join(parts).replace("@FLAGS", f"@{flags}") + "\n"
    return joined, writer.cells, writer.values
