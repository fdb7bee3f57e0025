"""An evaluator of lifted terms that shares nothing with the lifter, and the comparison with what runs."""

import contextlib
import inspect
import math
from fractions import Fraction
from typing import get_type_hints

import z3

from cratous.core.well_clear import interval
from cratous.proofs.engine import symbolic
from cratous.proofs.engine.lift import lift
from cratous.proofs.engine.symbolic import SymBool, SymInt, SymMask, SymReal
from cratous.proofs.mutation.inputs import inputs, run
from cratous.spec import well_clear

SAMPLES = 2000
MASKS = {
    "eligible": {0, 1},
    "tasks_with": {0, 1},
    "operand_fits": {0, 1, 2},
    "stands_in": {0, 1},
    "stands_in_one_of": {0, 1, 2},
    "none_beside": {0, 1, 2, 3},
    "opened": {0, 1},
    "all_needed_done": {0, 1},
    "vehicle_is_eligible": {0, 1, 2},
    "masks": {0, 1, 2},
}

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


def evaluator(terms, names):
    """A Python function of the values of `names` that computes the terms."""
    lines, known = [], {}

    def visit(term):
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
    scope = {"Fraction": Fraction, "divide": _divide, "modulo": _modulo}
    scope["arithmetic_shift"] = lambda a, b: (a - 2**64 if a >> 63 else a) >> b
    exec(body, scope)
    return scope["evaluate"]


def _divide(a, b):
    return Fraction(a) / b if b else Fraction(0)


def _modulo(a, b):
    return a % abs(b) if b else 0


def _flat(value):
    return [x for part in value for x in _flat(part)] if isinstance(value, tuple) else [value]


def _symbol(hint, name, mask):
    if mask:
        return SymMask(z3.BitVec(name, 64))
    if hint in (float, int, bool):
        made = {float: (SymReal, z3.Real), int: (SymInt, z3.Int), bool: (SymBool, z3.Bool)}
        wrapper, constant = made[hint]
        return wrapper(constant(name))
    return hint(*[_symbol(h, f"{name}.{f}", False) for f, h in get_type_hints(hint).items()])


def differences(function, count=SAMPLES):
    """Inputs on which the lifted term, or what it owes, disagrees with the running function."""
    masks = frozenset(MASKS.get(function.__name__, ()))
    hints = get_type_hints(function)
    names = list(inspect.signature(function).parameters)
    symbols = [_symbol(hints[n], n, k in masks) for k, n in enumerate(names)]
    leaves = [str(symbol.term) for symbol in _flat(tuple(symbols))]
    lifted = lift(function, *symbols)
    values = _flat(lifted.value)
    terms = [symbolic._raw(v) for v in values]
    owed = [condition for text, condition in lifted.obligations if "64 bits" not in text]
    # the argument of each root stands in its defining fact: argument >= 0 implies r >= 0 and ...
    roots = [(str(f.arg(1).arg(0).arg(0)), f.arg(0).arg(0)) for f in lifted.roots]
    evaluate, arguments = evaluator([*terms, *owed], leaves), []
    for name, argument in roots:
        arguments.append((name, evaluator([argument], leaves)))
    found = []
    for row in inputs(function, masks, count):
        given = dict(zip(leaves, _flat(row), strict=True))
        for name, argument in arguments:
            given[name] = whole_root(argument(given)[0])
        with whole_roots(function):
            wanted = run(function, row)
        answer = evaluate(given)
        got, conditions = answer[: len(terms)], answer[len(terms) :]
        if isinstance(wanted, str):
            if all(conditions):
                found.append((row, "undefined, but nothing is owed"))
            continue
        same = [_kind(a) == _kind(b) and a == b for a, b in zip(got, _flat(wanted), strict=True)]
        if not all(same):
            found.append((row, got, wanted))
    return found


def whole_root(value):
    """Stands for the root on both sides, so that the comparison stays rational."""
    return Fraction(math.isqrt(int(max(0, value))))


def checked_root(value):
    """The same in the running function, which refuses a negative one."""
    return math.sqrt(value) if value < 0 else whole_root(value)


@contextlib.contextmanager
def whole_roots(function):
    """While this lasts, the function and what it may call take `whole_root`s."""
    scopes = [vars(interval), vars(well_clear), function.__globals__]
    scopes = [scope for scope in scopes if scope.get("sqrt") is math.sqrt]
    for scope in scopes:
        scope["sqrt"] = checked_root
    try:
        yield
    finally:
        for scope in scopes:
            scope["sqrt"] = math.sqrt


def _kind(value):
    return "truth" if isinstance(value, bool) else "number"
