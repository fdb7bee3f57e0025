"""The second stage of the exact reading: values as pairs of doubles with an error bound.

Every real value of a comparison is represented as (high, low, left_out): the value differs from high + low by at most
left_out, and high is their rounded sum. Sums and products of doubles are split into the rounded result and the exact
rest (`core.readings.exact.expansion_arithmetic`); left_out is 0 where nothing was dropped, and there a pair decides
exact ties too. The errors are bounded by proved kernels (`core.readings.exact.certainty`: sum_left_out,
factors_left_out, product_left_out). Nothing is approximated silently: what a pair cannot decide goes on to residues
and expansions.

The bound is itself rounded, by a relative error of less than 2^-48 for each operation; `WIDER` covers a million of
them. It does not underflow where `expansions.reach` admits the input: every part of a value is a multiple of 2^-960,
and the least share of one that is counted is 2^-52.
"""

from __future__ import annotations

from cratous.core.readings.exact.certainty import (
    factors_left_out,
    product_left_out,
    sum_left_out,
    surely_above,
    surely_below,
)
from cratous.core.readings.exact.error_bounds import UNIT
from cratous.core.readings.graph.nodes import Node
from cratous.core.readings.graph.printing import name
from cratous.core.readings.machine.source_text import SourceText

WIDER = 1.0 + 2.0**-20
"""The error bound is enlarged by this factor, to cover the roundings of its own computation."""
MOST_LINES = 300
"""Beyond this many lines for one kernel, comparisons go directly to the expansions: code takes time to compile."""

ARITHMETIC = '''
@FLAGS
def sum_of_pair(ah, al, ar, y):
    """A pair plus a double."""
    s, e = two_sum(ah, y)
    m, g = two_sum(e, al)
    h, l = two_sum(s, m)
    return h, l, sum_left_out(ar, 0.0, 0.0, g)


@FLAGS
def sum_of_pairs(ah, al, ar, bh, bl, br):
    """A pair plus a pair."""
    s, e = two_sum(ah, bh)
    t, f = two_sum(al, bl)
    m, g = two_sum(e, t)
    h, l = two_sum(s, m)
    return h, l, sum_left_out(ar, br, f, g)


@FLAGS
def product_of_pair(ah, al, ar, y):
    """A pair times a double."""
    p, e = two_product(ah, y)
    c = al * y
    m, g = two_sum(e, c)
    h, l = two_sum(p, m)
    size = abs(ah) + abs(al)
    left = factors_left_out(ar, 0.0, size, abs(y))
    return h, l, product_left_out(left, c, 0.0, 0.0, 0.0, g, SHARE)


@FLAGS
def product_of_pairs(ah, al, ar, bh, bl, br):
    """A pair times a pair."""
    p, e = two_product(ah, bh)
    c = ah * bl
    d = al * bh
    t, f = two_sum(c, d)
    m, g = two_sum(e, t)
    h, l = two_sum(p, m)
    m, n = abs(ah) + abs(al), abs(bh) + abs(bl)
    left = factors_left_out(ar, br, m, n)
    return h, l, product_left_out(left, c, d, al * bl, f, g, SHARE)
'''


def arithmetic(flags: str) -> str:
    """The functions of one sum and one product, and the kernels that bound the error."""
    rules = SourceText(flags)
    kernels = (sum_left_out, factors_left_out, product_left_out, surely_above, surely_below)
    names = [f"{kernel.__name__} = {rules.add(kernel)}" for kernel in kernels]
    head = f"SHARE = {float(2 * UNIT)!r}"
    own = ARITHMETIC.strip().replace("@FLAGS", f"@{flags}")
    return "\n\n\n".join([rules.text, *names, head, own]) + "\n"


NAMES = (
    "product_of_pair, product_of_pairs, sum_of_pair, sum_of_pairs, surely_above, surely_below, "
    "two_product, two_sum"
)


class Pair:
    """The text of one value: high, low, left out; `double` if it is one double by itself."""

    def __init__(self, high: str, low: str = "0.0", left: str = "0.0") -> None:
        self.high, self.low, self.left = high, low, left
        self.double = low == "0.0" and left == "0.0"

    @property
    def parts(self) -> str:
        """high, low, left out."""
        return f"{self.high}, {self.low}, {self.left}"

    def negative(self) -> Pair:
        """The value with the other sign."""
        return Pair(f"(-{self.high})", self.low if self.double else f"(-{self.low})", self.left)


class Writer:
    """Writes lines that compute pairs; `lines` grows as values are requested."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.made: dict[int, Pair] = {}

    def combined(self, what: str, number: int | str, a: Pair, b: Pair) -> Pair:
        """a + b or a * b, as `what` is "sum" or "product", in variables of its own."""
        pair = Pair(f"h{number}", f"l{number}", f"r{number}")
        names, value = pair.parts, f"{what}_of_pairs({a.parts}, {b.parts})"
        if a.double and b.double:
            pair = Pair(pair.high, pair.low)
            names, value = f"{pair.high}, {pair.low}", f"two_{what}({a.high}, {b.high})"
        elif a.double or b.double:
            a, b = (b, a) if a.double else (a, b)
            value = f"{what}_of_pair({a.parts}, {b.high})"
        self.lines.append(f"    {names} = {value}")
        return pair

    def chosen(self, number: int, a: Pair, b: Pair, left: str | None = None) -> Pair:
        """a where `t` with the number holds, else b; left: the error bound, if not theirs."""
        pair = Pair(f"h{number}", f"l{number}", f"r{number}")
        parts = (
            (pair.high, a.high, b.high, None),
            (pair.low, a.low, b.low, None),
            (pair.left, a.left, b.left, left),
        )
        for into, x, y, given in parts:
            self.lines.append(f"    {into} = {given or f'{x} if t{number} else {y}'}")
        return pair

    def value(self, node: Node) -> None:
        """Write one node, with its operands done; the truth value of an `if` is in `t` with its number."""
        number, args = node.number, [self.made[a.number] for a in node.args if a.kind == "float"]
        if node.op in ("in", "lit"):
            made = Pair(name(node))
        elif node.op == "add":
            made = self.combined("sum", number, *args)
        elif node.op == "sub":
            made = self.combined("sum", number, args[0], args[1].negative())
        elif node.op == "mul":
            made = self.combined("product", number, *args)
        elif node.op == "neg":
            made = args[0].negative()
        elif node.op == "if":
            made = self.chosen(number, args[0], args[1])
        elif node.op == "abs":
            a = args[0]
            self.lines.append(f"    t{number} = {a.high} < 0")
            made = self.chosen(number, a.negative(), a)
        else:
            a, b = args
            sign = "<" if node.op == "min" else ">"
            sooner = f"{b.high} {sign} {a.high}"
            later = f"{b.high} == {a.high} and {b.low} {sign} {a.low}"
            self.lines.append(f"    t{number} = {sooner} or ({later})")
            made = self.chosen(number, b, a, f"{a.left} + {b.left}")
        self.made[number] = made

    def sign(self, a: Node, b: Node, known: str) -> str:
        """Store the sign of a - b into `known` and return it, where it is certain.

        Returns the text of the high part of a - b; its error bound is in `bound`.
        """
        if b.op == "lit" and b.value == 0:
            gap = self.made[a.number]
        else:
            gap = self.combined("sum", "", self.made[a.number], self.made[b.number].negative())
        self.lines += [
            f"    bound = {WIDER!r} * (abs({gap.low}) + {gap.left})",
            f"    sign = 1.0 if surely_above({gap.high}, bound) else 0.0",
            f"    sign = -1.0 if surely_below({gap.high}, bound) else sign",
            f"    if sign != 0 or (bound == 0 and {gap.high} == 0):",
            f"        {known} = sign",
            "        return sign",
        ]
        return gap.high
