"""Exact signs of values near 0, from their residues: the continuation of pairs of doubles.

Every real value of a comparison is an integer multiple of a unit 2^e, as doubles are. Where the pair
(`core.readings.exact.double_pairs`) bounds a difference to less than 2^126 of its units, its residue modulo 2^128 is
the difference itself, in two's complement: so an exact tie of numbers with all bits set, which no two doubles can
represent, costs about as much as the pair, and only values that span more than some 230 bits are left to
`core.readings.exact.expansions`. A value is (high, low, exponent), two words of 64 bits; sums shift the one with the
coarser unit, and what is shifted out is a multiple of 2^128.
"""

from __future__ import annotations

from cratous.core.readings.graph.nodes import Node
from cratous.core.readings.graph.printing import name

ARITHMETIC = '''
ZERO = np.uint64(0)
ONE = np.uint64(1)
HALF = np.uint64(32)
WORD = np.uint64(64)
ALL = np.uint64(0xFFFFFFFF)
# the exponent of 0, which is a whole number of any unit
ANY = 1 << 40


@FLAGS
def residue(x):
    """A double that is 0 or not subnormal."""
    if x == 0:
        return ZERO, ZERO, ANY
    bits = np.float64(x).view(np.int64)
    low = np.uint64((bits & 0xFFFFFFFFFFFFF) | 0x10000000000000)
    exponent = ((bits >> 52) & 2047) - 1075
    if bits < 0:
        return ~ZERO, ZERO - low, exponent
    return ZERO, low, exponent


@FLAGS
def negative_residue(h, l, e):
    """With the other sign."""
    return (~h + ONE if l == ZERO else ~h), ZERO - l, e


@FLAGS
def shifted_residue(h, l, n):
    """Times 2^n, n >= 0."""
    if n >= 64:
        return (l << np.uint64(n - 64) if n < 128 else ZERO), ZERO
    if n == 0:
        return h, l
    k = np.uint64(n)
    return (h << k) | (l >> (WORD - k)), l << k


@FLAGS
def sum_of_residues(ah, al, ae, bh, bl, be):
    """Their sum, in the finer unit."""
    if ae > be:
        ah, al = shifted_residue(ah, al, ae - be)
        ae = be
    else:
        bh, bl = shifted_residue(bh, bl, be - ae)
    low = al + bl
    return ah + bh + (ONE if low < al else ZERO), low, ae


@FLAGS
def product_of_residues(ah, al, ae, bh, bl, be):
    """Their product, in the product of the units."""
    a = al & ALL
    b = al >> HALF
    c = bl & ALL
    d = bl >> HALF
    ac = a * c
    ad = a * d
    bc = b * c
    middle = (ac >> HALF) + (ad & ALL) + (bc & ALL)
    high = b * d + (ad >> HALF) + (bc >> HALF) + (middle >> HALF)
    return high + al * bh + ah * bl, (ac & ALL) | (middle << HALF), ae + be


@FLAGS
def sign_of_residue(h, l, e, bound):
    """The sign of a value of at most this magnitude; 2 where its residue may be another's."""
    most = ((np.float64(bound).view(np.int64) >> 52) & 2047) - 1022
    if most > e + 126:
        return 2.0
    if h >> np.uint64(63) != ZERO:
        return -1.0
    return 0.0 if h == ZERO and l == ZERO else 1.0
'''

NAMES = "negative_residue, product_of_residues, residue, sign_of_residue, sum_of_residues"
READ = ("in", "lit", "add", "sub", "mul", "neg", "if")
"""Operations that need no comparison of values: the others are left to the expansions."""


def arithmetic(flags: str) -> str:
    """The functions of one sum and one product."""
    return ARITHMETIC.strip().replace("@FLAGS", f"@{flags}") + "\n"


def lines(nodes: list[Node], a: Node, b: Node, high: str, bound: str, known: str) -> list[str]:
    """Lines that store the sign of a - b into `known` and return it, where its residue determines it.

    nodes: what a and b need, operands first; high, bound: of the pair of doubles for a - b; the condition of an `if`
    is in the variable `t` with its number. [] if a node has no residue.
    """
    if any(node.op not in READ for node in nodes):
        return []
    found = []

    def parts(node: Node | str) -> str:
        number = node if isinstance(node, str) else node.number
        return f"u{number}, v{number}, e{number}"

    def negative(node: Node) -> str:
        found.append(f"    {parts('')} = negative_residue({parts(node)})")
        return parts("")

    for node in nodes:
        args = [arg for arg in node.args if arg.kind == "float"]
        if node.op in ("in", "lit"):
            value = f"residue({name(node)})"
        elif node.op == "neg":
            value = f"negative_residue({parts(args[0])})"
        elif node.op == "if":
            value = f"({parts(args[0])}) if t{node.number} else ({parts(args[1])})"
        elif node.op == "mul":
            value = f"product_of_residues({parts(args[0])}, {parts(args[1])})"
        else:
            second = parts(args[1]) if node.op == "add" else negative(args[1])
            value = f"sum_of_residues({parts(args[0])}, {second})"
        found.append(f"    {parts(node)} = {value}")
    found.append(f"    {parts('')} = sum_of_residues({parts(a)}, {negative(b)})")
    return [
        *found,
        f"    sign = sign_of_residue({parts('')}, abs({high}) + {bound})",
        "    if sign != 2:",
        f"        {known} = sign",
        "        return sign",
    ]
