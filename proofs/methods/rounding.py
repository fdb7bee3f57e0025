"""The float filter's proof, generated from the same graphs from which its code is generated.

What is proved, in four links, of which the first and the third are obligations made here:

1. `bounds`: for each rule and each pair of bounds that occurs in the filter of any kernel, the
   bound that `core.readings.exact.float_filter` computed (its count of roundings) covers what the theorems
   `rounding_of_*` say of one operation: linear obligations in the sizes, with the same numbers.
2. `rounding_of_a_sum|product|choice_is_bounded`, `rounding_verdict_is_certain`: one operation and
   one comparison, for all real numbers, from the model in `spec.rounding`.
3. `verdicts`: the kernel's graph equals the lifted kernel; and if every comparison that the filter
   calls certain is right, then so is the verdict that it calls certain.
4. Not an obligation: that the bounds of 1 are chained correctly along the graph (the filter passes
   each node's bound to its users, which is checked here), that a result which
   overflows makes its size infinite or NaN, that the printed code is the graph, and that numba
   and the machine conform to the model. Tests cover these: exact rationals against the filter.
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

import z3

from cratous.core.ledger import load_all
from cratous.core.readings.exact.certainty import surely_above, surely_below
from cratous.core.readings.exact.error_bounds import FLOOR, TINY, UNIT
from cratous.core.readings.exact.float_filter import Certain, Filter, Step, filtered
from cratous.core.readings.graph import program
from cratous.core.readings.graph.nodes import Node, NotInSubset, Program, leaves
from cratous.proofs.engine.claim import Claim
from cratous.proofs.engine.obligation import Obligation
from cratous.proofs.engine.symbolic import Sym, wrap
from cratous.spec import rounding


def filters(package: str = "cratous.core.") -> dict[str, tuple[Any, Filter]]:
    """Every registered kernel of a package that has a filter and real arguments, by name."""
    found = {}
    for name, entry in load_all().items():
        if entry.kind != "kernel" or not entry.function.__module__.startswith(package):
            continue
        try:
            made = filtered(entry.function)
        except NotInSubset:
            continue
        if any(column.kind == "float" for column in made.program.columns):
            found[name] = (entry.function, made)
    return found


def _number(value: Fraction) -> Any:
    return wrap(z3.RealVal(f"{value.numerator}/{value.denominator}"))


def _state(c: Claim, text: str, premises: Iterable[Any], goal: Any) -> None:
    """Add one self-contained obligation."""
    c.obligations.append(Obligation("goal", text, tuple(p.term for p in premises), goal.term))


# -- the bounds -------------------------------------------------------------------------
class _Rules:
    """States one application of a rule as an obligation, on the values of one claim."""

    def __init__(self, c: Claim) -> None:
        self.c = c
        self.p1, self.p2, self.p, self.scaled, self.bound = c.reals("p1 p2 p scaled bound")
        self.value, self.real = c.reals("value real")
        self.unit, self.tiny = _number(UNIT), _number(TINY)

    def rounded(self, result: Any, real: Any, tiny: Any = 0) -> Any:
        return self.c.define(rounding.rounded, result, real, self.unit, tiny)

    def ordered(self, less: Any, more: Any, less_rounded: Any, more_rounded: Any) -> Any:
        return self.c.define(rounding.keeps_order, less, more, less_rounded, more_rounded)

    def error(self, bound: Any, size: Any) -> Any:
        return _number(bound.factor) * size + _number(bound.slack)

    def state(self, step: Step) -> None:
        """The obligation of one step."""
        shown = ", ".join(f"{float(b.factor * 2**53):.4g}u" for b in step.before)
        text = f"{step.rule} of {shown} is within {float(step.after.factor * 2**53):.4g}u"
        rules = {
            "sum": self.sum, "product": self.product, "double": self.double, "floor": self.floor,
            "choice": self.choice, "min": self.choice, "max": self.choice, "sign": self.sign,
        }  # fmt: skip
        rules[step.rule](step, text)

    def sum(self, step: Step, text: str) -> None:
        a, b = step.before
        left = self.error(a, self.p1) + self.error(b, self.p2) + self.unit * self.p
        premises = [self.p1 >= 0, self.p2 >= 0, self.p1 + self.p2 <= self.p + self.unit * self.p]
        _state(self.c, text, premises, left <= self.error(step.after, self.p))

    def product(self, step: Step, text: str) -> None:
        a, b = step.before
        if a.slack or b.slack:
            raise ValueError("a factor of a product has slack")
        growth = _number(a.factor + b.factor + a.factor * b.factor)
        # p1 stands for the product of the sizes
        left = growth * self.p1 + self.unit * self.p + self.tiny
        premises = [self.p1 >= 0, self.p1 <= self.p + self.unit * self.p + self.tiny]
        _state(self.c, text, premises, left <= self.error(step.after, self.p))

    def double(self, step: Step, text: str) -> None:
        times = _number(step.constants[0])
        left = times * self.error(step.before[0], self.p1)
        _state(self.c, text, [self.p1 >= 0], left <= self.error(step.after, times * self.p1))

    def floor(self, step: Step, text: str) -> None:
        least = _number(FLOOR)
        premises = [
            self.p1 >= 0,
            self.ordered(self.p1, self.p1 + least, self.p1, self.p),
            self.ordered(least, self.p1 + least, least, self.p),
        ]
        left = self.error(step.before[0], self.p1)
        _state(self.c, text, premises, left <= self.error(step.after, self.p))

    def choice(self, step: Step, text: str) -> None:
        for size, bound in zip((self.p1, self.p2), step.before, strict=True):
            left = self.error(bound, size)
            premises = [size >= 0, self.p >= size]
            _state(self.c, text, premises, left <= self.error(step.after, self.p))

    def sign(self, step: Step, text: str) -> None:
        factor, least = (_number(constant) for constant in step.constants)
        premises = [
            self.p >= 0,
            self.rounded(self.scaled, factor * self.p, self.tiny),
            self.rounded(self.bound, self.scaled + least),
            self.c.define(
                rounding.near, self.value, self.real, self.p, self.error(step.after, self.p)
            ),
        ]
        above = self.c.use(surely_above, self.value, self.bound)
        below = self.c.use(surely_below, self.value, self.bound)
        _state(self.c, f"{text}: above", [*premises, above], self.real > 0)
        _state(self.c, f"{text}: below", [*premises, below], self.real < 0)


def bounds(c: Claim, found: Iterable[Filter]) -> None:
    """Obligations: every bound in these filters covers the error of its operation."""
    rules = _Rules(c)
    steps = {step: None for made in found for step in made.steps}
    for step in steps:
        rules.state(step)


# -- the verdicts -----------------------------------------------------------------------
RELATIONS = {
    "lt": lambda a, b: a < b,
    "le": lambda a, b: a <= b,
    "gt": lambda a, b: a > b,
    "ge": lambda a, b: a >= b,
    "eq": lambda a, b: a == b,
    "ne": lambda a, b: a != b,
}


def _literal(node: Node) -> z3.ExprRef:
    if node.kind == "bool":
        return z3.BoolVal(node.value)
    return z3.IntVal(node.value) if node.kind == "int" else z3.RealVal(Fraction(node.value))


def evaluate(nodes: Iterable[Node], known: dict[int, z3.ExprRef]) -> dict[int, z3.ExprRef]:
    """The z3 terms of a graph's nodes over real numbers; `known` holds terms of columns and given nodes."""
    made = dict(known)
    for node in nodes:
        if node.number in made:
            continue
        if node.op == "lit":
            made[node.number] = _literal(node)
            continue
        if node.op == "in":
            raise ValueError(f"no value for the column {node.value}")
        if any(arg.number not in made for arg in node.args):
            continue  # depends on a node that is not looked into
        made[node.number] = _operation(node.op, [made[arg.number] for arg in node.args])
    return made


def _operation(op: str, args: list[Any]) -> z3.ExprRef:
    if op in RELATIONS:
        return RELATIONS[op](*args)
    if op in ("bitand", "bitor"):
        if not all(z3.is_bv(arg) for arg in args):
            raise NotInSubset("a mask that is used as a number")
        return args[0] & args[1] if op == "bitand" else args[0] | args[1]
    simple = {
        "add": lambda a, b: a + b,
        "sub": lambda a, b: a - b,
        "mul": lambda a, b: a * b,
        "and": z3.And,
        "or": z3.Or,
        "xor": z3.Xor,
        "not": z3.Not,
        "if": z3.If,
        "neg": lambda a: -a,
        "abs": lambda a: z3.If(a >= 0, a, -a),
        "min": lambda a, b: z3.If(a <= b, a, b),
        "max": lambda a, b: z3.If(a >= b, a, b),
    }
    return simple[op](*args)


def _arguments(c: Claim, name: str, source: Program, kernel: Any) -> tuple[list[Any], list[Any]]:
    """Arbitrary arguments of a kernel, and the same as a flat list in the order of its columns."""
    make = {"float": c.real, "int": c.integer, "bool": c.boolean}
    flat = [
        make[column.kind](f"{name}.{label}")
        for column, label in zip(source.columns, source.labels, strict=True)
    ]
    from typing import get_type_hints

    left = list(flat)

    def built(kind: Any) -> Any:
        fields = get_type_hints(kind) if hasattr(kind, "_fields") else None
        return kind(*[built(fields[f]) for f in fields]) if fields else left.pop(0)

    hints = get_type_hints(kernel)
    return [built(kind) for key, kind in hints.items() if key != "return"], flat


def _parts(value: Any) -> list[Any]:
    return (
        [part for item in value for part in _parts(item)] if isinstance(value, tuple) else [value]
    )


def _any_arithmetic(term: z3.ExprRef, done: dict[int, z3.ExprRef]) -> z3.ExprRef:
    """The term with + - * on reals replaced by arbitrary functions: equal terms stay equal."""
    key = term.get_id()
    if key not in done:
        args = [_any_arithmetic(arg, done) for arg in term.children()]
        name = ARBITRARY.get(term.decl().kind()) if z3.is_app(term) and z3.is_real(term) else None
        if name is None:
            done[key] = term.decl()(*args) if args else term
        else:
            real = z3.RealSort()
            operation = z3.Function(f"any_{name}", *[real] * (min(len(args), 2) + 1))
            done[key] = operation(args[0]) if len(args) == 1 else args[0]
            for arg in args[1:]:
                done[key] = operation(done[key], arg)
    return done[key]


ARBITRARY = {
    z3.Z3_OP_ADD: "sum",
    z3.Z3_OP_SUB: "difference",
    z3.Z3_OP_MUL: "product",
    z3.Z3_OP_UMINUS: "negative",
}


def graph_is_kernel(c: Claim, name: str, kernel: Any) -> None:
    """Obligation: the graph computes what the lifted kernel computes, for any meaning of + - *.

    So it carries out the same operations on the same operands, on doubles as on real numbers.
    """
    source = program(kernel)
    args, flat = _arguments(c, name, source, kernel)
    lifted = _parts(c.define(kernel, *args))
    columns = {k.number: v.term for k, v in zip(source.columns, flat, strict=True)}
    terms = evaluate(source.nodes, columns)
    done: dict[int, z3.ExprRef] = {}
    for leaf, theirs in zip(leaves(source.result), lifted, strict=True):
        equal = terms[leaf.number] == _constant(theirs, leaf.kind)
        _state(c, f"{name}: graph and kernel", [], wrap(_any_arithmetic(equal, done)))


def _constant(value: Any, kind: str) -> z3.ExprRef:
    """The term of a lifted result, which may be a plain literal."""
    if isinstance(value, Sym):
        return value.term
    if kind == "bool":
        return z3.BoolVal(value)
    return z3.IntVal(value) if kind == "int" else z3.RealVal(Fraction(value))


def verdicts(c: Claim, name: str, made: Filter) -> None:
    """Obligations: certain verdicts are right if the certain comparisons are.

    A comparison is represented by the sign of an arbitrary real number (the difference of its sides), its float value
    by an arbitrary number within the bound of it.
    """
    source = made.program
    given: list[Any] = []
    ours: dict[int, z3.ExprRef] = {}
    theirs: dict[int, z3.ExprRef] = {}
    for column in source.columns:
        if column.kind == "float":
            continue
        make = {"int": c.integer, "bool": c.boolean}[column.kind]
        value = make(f"{name}.{column.value}").term
        ours[column.number] = value
        theirs[made.terms.column(column.value, column.kind).number] = value
    reals: dict[tuple[int, int], Any] = {}
    tested: dict[int, list[Any]] = {}
    near: set[tuple[int, int, int]] = set()
    for found in made.compared:
        a, b = (arg.number for arg in found.original.args)
        if (a, b) not in reals:
            reals[a, b] = c.real(f"{name}.difference{a}_{b}")
        real = reals[a, b]
        ours[found.original.number] = RELATIONS[found.original.op](real.term, z3.RealVal(0))
        if found.above is None or found.below is None:
            theirs[found.certain.yes.number] = ours[found.original.number]
            continue
        test = found.above.number
        if test not in tested:
            tested[test] = [c.real(f"{name}.{part}{a}_{b}") for part in ("value", "size", "bound")]
            value, _, bound = tested[test]
            theirs[test] = c.use(surely_above, value, bound).term
            theirs[found.below.number] = c.use(surely_below, value, bound).term
        # one test may represent several comparisons: x <= y, and x - y <= 0
        if (a, b, test) not in near:
            near.add((a, b, test))
            value, size, bound = tested[test]
            given.append(c.define(rounding.near, value, real, size, bound))
    finite = c.boolean(f"{name}.finite").term
    roots = [made.sure]
    for result in made.results:
        roots += [result.yes, result.no] if isinstance(result, Certain) else [result]
    nodes = sorted(made.terms.made.values(), key=lambda node: node.number)
    for node in nodes:
        # sums of sizes are compared only to test for overflow
        if node.op == "le" and node.number not in theirs and node.args[0].kind == "float":
            theirs[node.number] = finite
    decided = [n for n in source.nodes if n.kind != "float"]
    real_terms = evaluate(decided, ours)
    filter_terms = evaluate([n for n in nodes if n.op != "in"], theirs)
    sure = wrap(filter_terms[made.sure.number])
    for node in source.nodes:
        if node.op == "if":
            certain = {n.number: s for n, s in made.states}[node.args[0].number]
            yes = wrap(filter_terms[certain.yes.number] == real_terms[node.args[0].number])
            _state(c, f"{name}: a choice is right", [*given, sure], yes)
    for leaf, result in zip(leaves(source.result), made.results, strict=True):
        if leaf.kind == "float":
            continue
        real = real_terms[leaf.number]
        if isinstance(result, Certain):
            yes, no = (wrap(filter_terms[n.number]) for n in (result.yes, result.no))
            _state(c, f"{name}: surely true", [*given, sure, yes], wrap(real))
            _state(c, f"{name}: surely false", [*given, sure, no], wrap(z3.Not(real)))
        else:
            same = wrap(filter_terms[result.number] == real)
            _state(c, f"{name}: the result", [*given, sure], same)
