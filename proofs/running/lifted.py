"""The lifted term as a reading: an evaluator of z3 terms on numbers that shares no code with the lifter."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, get_type_hints

import z3

from cratous.proofs.engine.lift import Lifted, lift
from cratous.proofs.engine.symbolic import RANGE, SymMask, _raw
from cratous.proofs.engine.terms import fresh, leaves
from cratous.proofs.mutation.inputs import run
from cratous.proofs.running.copies import with_root

OPERATORS = {
    z3.Z3_OP_TRUE: "True",
    z3.Z3_OP_FALSE: "False",
    z3.Z3_OP_EQ: "({0} == {1})",
    z3.Z3_OP_DISTINCT: "({0} != {1})",
    z3.Z3_OP_XOR: "({0} != {1})",
    z3.Z3_OP_NOT: "(not {0})",
    z3.Z3_OP_IMPLIES: "(not {0} or {1})",
    z3.Z3_OP_LE: "({0} <= {1})",
    z3.Z3_OP_LT: "({0} < {1})",
    z3.Z3_OP_GE: "({0} >= {1})",
    z3.Z3_OP_GT: "({0} > {1})",
    z3.Z3_OP_SUB: "({0} - {1})",
    z3.Z3_OP_UMINUS: "(-{0})",
    z3.Z3_OP_DIV: "divide({0}, {1})",
    z3.Z3_OP_MOD: "modulo({0}, {1})",
    z3.Z3_OP_TO_REAL: "{0}",
    z3.Z3_OP_ITE: "({1} if {0} else {2})",
    z3.Z3_OP_BLSHR: "({0} >> {1})",
    z3.Z3_OP_BASHR: "arithmetic_shift({0}, {1})",
    z3.Z3_OP_BSHL: "(({0} << min({1}, 64)) & (2**64 - 1))",
    z3.Z3_OP_ULT: "({0} < {1})",
}
CHAINS = {
    z3.Z3_OP_AND: " and ",
    z3.Z3_OP_OR: " or ",
    z3.Z3_OP_ADD: " + ",
    z3.Z3_OP_MUL: " * ",
    z3.Z3_OP_BAND: " & ",
    z3.Z3_OP_BOR: " | ",
    z3.Z3_OP_BXOR: " ^ ",
}


def evaluator(terms: Iterable[z3.ExprRef]) -> Callable[[dict[str, Any]], list[Any]]:
    """A Python function that computes these terms from the values of their variables by name."""
    lines: list[str] = []
    known: dict[int, str] = {}

    def visit(term: z3.ExprRef) -> str:
        key = term.get_id()
        if key in known:
            return known[key]
        parts = [visit(child) for child in term.children()]
        kind = term.decl().kind()
        if z3.is_rational_value(term):
            text = f"Fraction({term.numerator_as_long()}, {term.denominator_as_long()})"
        elif z3.is_int_value(term) or z3.is_bv_value(term):
            text = str(term.as_long())
        elif z3.is_const(term) and kind == z3.Z3_OP_UNINTERPRETED:
            text = f"values[{str(term)!r}]"
        elif kind in CHAINS:
            text = "(" + CHAINS[kind].join(parts) + ")"
        else:
            text = OPERATORS[kind].format(*parts)
        known[key] = f"x{len(known)}"
        lines.append(f"    {known[key]} = {text}")
        return known[key]

    results = [visit(term) for term in terms]
    body = "\n".join(["def evaluate(values):", *lines, f"    return [{', '.join(results)}]"])
    scope: dict[str, Any] = {"Fraction": Fraction, "divide": _divide, "modulo": _modulo}
    scope["arithmetic_shift"] = lambda a, b: (a - 2**64 if a >> 63 else a) >> b
    exec(body, scope)
    made: Callable[[dict[str, Any]], list[Any]] = scope["evaluate"]
    return made


def _divide(a: Any, b: Any) -> Any:
    return Fraction(a) / b if b else Fraction(0)


def _modulo(a: Any, b: Any) -> Any:
    return a % abs(b) if b else 0


def whole_root(value: Any) -> Any:
    """An integer square root in place of the root on both sides, so that the comparison stays rational."""
    return Fraction(math.isqrt(int(max(0, value))))


def checked_root(value: Any) -> Any:
    """The same for the running function; raises ValueError for a negative argument."""
    return math.sqrt(value) if value < 0 else whole_root(value)


def symbol(kind: Any, name: str, mask: bool) -> Any:
    """An arbitrary value of a parameter's type."""
    return SymMask(z3.BitVec(name, 64)) if mask else fresh(name, kind)


@dataclass(frozen=True)
class Term:
    """A function's lifted term prepared for evaluation: result, side conditions, and which of these are 64-bit
    bounds."""

    names: tuple[str, ...]
    size: int
    whole: tuple[bool, ...]
    evaluate: Callable[[dict[str, Any]], list[Any]]
    roots: tuple[tuple[str, Callable[[dict[str, Any]], list[Any]]], ...]

    def __call__(self, row: tuple[Any, ...]) -> tuple[list[Any], bool, bool]:
        """(values, whether all side conditions hold, whether those other than the 64-bit bounds hold)."""
        given = dict(zip(self.names, leaves(row), strict=True))
        for name, argument in self.roots:
            given[name] = whole_root(argument(given)[0])
        found = self.evaluate(given)
        owed = found[self.size :]
        fits = all(owed)
        return (
            found[: self.size],
            fits,
            all(o for o, w in zip(owed, self.whole, strict=True) if not w),
        )


def term_of(function: Callable[..., Any], masks: frozenset[int]) -> Term:
    """The lifted term of a function; masks: positions of bit masks. Raises LiftError where it cannot be lifted."""
    hints = get_type_hints(function)
    parameters = list(inspect.signature(function).parameters)
    symbols = [symbol(hints[n], n, k in masks) for k, n in enumerate(parameters)]
    names = tuple(str(one.term) for one in leaves(tuple(symbols)))
    lifted: Lifted = lift(function, *symbols)
    terms = [_raw(value) for value in leaves(lifted.value)]
    owed = [condition for _, condition in lifted.obligations]
    whole = tuple(text.endswith(RANGE) for text, _ in lifted.obligations)
    # a root's argument is in its defining fact: argument >= 0 implies r >= 0 and ...
    roots = [(str(f.arg(1).arg(0).arg(0)), f.arg(0).arg(0)) for f in lifted.roots]
    return Term(
        names,
        len(terms),
        whole,
        evaluator([*terms, *owed]),
        tuple((name, evaluator([argument])) for name, argument in roots),
    )


def differences(
    function: Callable[..., Any],
    rows: Iterable[tuple[Any, ...]],
    masks: frozenset[int] = frozenset(),
    term: Term | None = None,
) -> list[tuple[tuple[Any, ...], Any, Any]]:
    """Rows where the lifted term or its side conditions disagree with the running function: (row, term, function)."""
    one = term or term_of(function, masks)
    return disagreeing(function, [(row, *one(row)) for row in rows])


def disagreeing(
    function: Callable[..., Any], evaluated: Iterable[tuple[tuple[Any, ...], list[Any], bool, bool]]
) -> list[tuple[tuple[Any, ...], Any, Any]]:
    """The same for terms already evaluated: each row with the results of `Term`."""
    running = with_root(function, checked_root)
    found: list[tuple[tuple[Any, ...], Any, Any]] = []
    for row, got, _, defined in evaluated:
        wanted = run(running, row)
        if isinstance(wanted, str):
            if defined:
                found.append((row, "a value, and nothing is owed", wanted))
        elif [_kind(a) for a in got] != [_kind(b) for b in leaves(wanted)] or got != leaves(wanted):
            found.append((row, got, wanted))
    return found


def _kind(value: Any) -> str:
    return "truth" if isinstance(value, bool) else "number"
