"""The lifter says what the function does: lifted term against running function, and seeded defects.

Every kernel and every definition is run on 2000 random rational inputs beside its lifted term.
The second half breaks the lifter on purpose, in one way at a time; each defect must be noticed
by these comparisons or by a check of what the lifter owes.
"""

from __future__ import annotations

import contextlib
import inspect
import math
from fractions import Fraction
from math import sqrt
from typing import NamedTuple, get_type_hints

import pytest
import z3

from cratous.core import ledger as gate
from cratous.core import well_clear_interval as interval
from cratous.core.kernel import REGISTRY, Fold
from cratous.proofs import claim as claim_module
from cratous.proofs import lift as lifter
from cratous.proofs import symbolic
from cratous.proofs.claim import Claim, Stub
from cratous.proofs.lift import LiftError, lift
from cratous.proofs.mutation_inputs import inputs, run
from cratous.proofs.symbolic import Path, SymBool, SymInt, SymMask, SymNumber, SymReal
from cratous.spec import authority, geofence, schedule, well_clear

gate.load_all()
SAMPLES = 2000
MASKS = {
    "eligible": {0, 1},
    "opened": {0, 1},
    "all_needed_done": {0, 1},
    "vehicle_is_eligible": {0, 1, 2},
    "masks": {0, 1, 2},
}
KERNELS = [e.function for e in REGISTRY.values() if e.kind == "kernel"]
DEFINITIONS = [
    function
    for module in (authority, geofence, schedule, well_clear)
    for _, function in inspect.getmembers(module, inspect.isfunction)
    if function.__module__ == module.__name__
]


# -- an evaluator of z3 terms that shares nothing with the lifter --------------------------
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


DEEP = ("daa_", "geofence_", "well_clear_during", "well_clear_interval", "well_clear_times")
"""Modules whose kernels have so many paths that lifting them takes minutes."""


def by_depth(functions):
    """The functions, those of deep modules marked."""
    return [
        pytest.param(f, marks=pytest.mark.long)
        if f.__module__.rpartition(".")[2].startswith(DEEP)
        else f
        for f in functions
    ]


@pytest.mark.parametrize("function", by_depth(KERNELS), ids=lambda f: f.__name__)
def test_a_lifted_kernel_is_the_running_kernel(function):
    assert differences(function) == []


@pytest.mark.parametrize("function", DEFINITIONS, ids=lambda f: f"{f.__module__}.{f.__name__}")
def test_a_lifted_definition_is_the_running_definition(function):
    assert differences(function) == []


# -- functions that use every part of the subset ------------------------------------------------
class Pair(NamedTuple):
    """Two numbers and a truth value."""

    low: float
    high: float
    odd: bool


def half(a: float, b: float) -> float:
    """Divides by what may be zero."""
    if a <= b:
        return (a - 1) / (2 * b)
    return b / (3 - a)


def ordered(a: float, b: float, odd: bool) -> Pair:
    """Records, min and max, xor, literals beside variables."""
    if odd != (a < b):
        return Pair(min(a, b), max(a, b, 1), odd)
    return Pair(0, 1 - abs(a), not odd)


def repeated(a: float, b: float) -> int:
    """The same condition twice on one path, then another."""
    if a <= 1:
        if a <= 1 and b <= 0:
            return 1
        if not a <= 1:
            return 2
        return 3
    if a <= 1 or b >= 0:
        return 4
    return 5


def connectives(a: float, b: float, c: bool) -> bool:
    """Both connectives, equality of reals, a chained comparison."""
    return (a == b and c) or (a != 0 and not c and 0 <= b < a) or a >= 3


def strict(a: float, b: float) -> int:
    """Every order, between values and beside literals."""
    if a > b:
        return 1
    if a < 2:
        return 2
    if b >= 3:
        return 3
    if b + a >= 4:
        return 4
    return 5


def masks(a: int, b: int, c: int) -> int:
    """Bit operations, literals on either side."""
    if (a & b) | (1 ^ c) == 0:
        return a >> 1
    return ((a | 6) & b) >> 2


def remainder(a: int, b: int) -> int:
    """A remainder, and arithmetic on integers."""
    if a % 3 == 1:
        return a - 2 * b
    return (b - 5) % 4


def callee(a: float, b: float) -> float:
    """Called by `caller`."""
    return a / b


def caller(a: float, b: float) -> float:
    """Calls a function that owes something."""
    if b >= 1:
        return callee(a, b) + 1
    return callee(b, a)


def length(a: float) -> float:
    """A root of a square."""
    return sqrt(4 * a * a) - 1


def bare_root(a: float) -> float:
    """A root of anything."""
    return sqrt(a)


def bad_mix(a: int, b: float) -> float:
    """An integer variable beside a real one."""
    return a * b


def bad_equality(a: float) -> bool:
    """A number is compared with a truth value."""
    return a == True  # noqa: E712


def endless(a: float) -> float:
    """Calls itself."""
    if a <= 0:
        return a
    return endless(a - 1)


def shifted(a: int, b: int) -> int:
    """Shifts by a variable."""
    return a << b


def product(a: int, b: int) -> int:
    """Leaves 64 bits."""
    return a * b


def product_of_callee(a: int, b: int) -> int:
    """Calls a function that leaves 64 bits."""
    return product(a, b)


def tally(seen: int, value: int) -> int:
    """A fold's step."""
    return max(seen, value)


def same_value(seen: int) -> int:
    """A fold's finish."""
    return seen


PROBES = [half, ordered, repeated, connectives, strict, masks, remainder, caller]


@pytest.mark.parametrize("function", PROBES, ids=lambda f: f.__name__)
def test_every_part_of_the_subset_is_lifted_right(function):
    assert differences(function) == []


# -- what the lifter and the claims owe ----------------------------------------------------------
def _holds(given, goal):
    solver = z3.Solver()
    solver.set("rlimit", 2_000_000)
    solver.add(*given, z3.Not(goal))
    return str(solver.check()) == "unsat"


def _owes(state, *kinds):
    """True iff some obligation of these kinds fails in the claim that `state` makes."""
    made = Claim(load=lambda name: LEMMAS[name])
    state(made)
    chosen = [o for o in made.obligations if o.kind in kinds]
    return any(not _holds(o.given, o.goal) for o in chosen)


def _undefined(function, *makers):
    def state(c):
        c.use(function, *[getattr(c, maker)(f"v{k}") for k, maker in enumerate(makers)])

    return lambda: _owes(state, "defined")


def _refused(state):
    def check():
        try:
            state(Claim(load=lambda name: LEMMAS[name]))
        except (LiftError, ValueError):
            return True
        return False

    return check


def _root_is_known():
    def state(c):
        a = c.real("a")
        c.premise(a >= 0)
        r = c.use(bare_root, a)
        c.show(c.same(r * r, a))
        c.show(r >= 0)

    return not _owes(state, "goal", "defined")


def _root_is_not_overstated():
    def state(c):
        a = c.real("a")
        c.use(bare_root, a)
        c.show(a >= 0)

    return _owes(state, "goal")


def _opaque_looks_at_arguments():
    def state(c):
        a, b = c.reals("a b")
        c.opaque(callee)
        c.show(c.same(c.use(callee, a, b), c.use(callee, b, a)))

    return _owes(state, "goal")


def _opaque_is_a_function():
    def state(c):
        a, b = c.reals("a b")
        c.opaque(callee)
        c.show(c.same(c.use(callee, a + b, b), c.use(callee, b + a, b)))

    return not _owes(state, "goal")


def _opaque_namesakes_are_two():
    def state(c):
        s, v = c.vector("s"), c.vector("v")
        d = c.real("d")
        kernel = REGISTRY["horizontal_violation"].function
        c.opaque(kernel, well_clear.horizontal_violation)
        ours = c.use(kernel, s, v, d, d)
        c.show(c.same(ours, c.define(well_clear.horizontal_violation, s, v, d, d)))

    return _owes(state, "goal")


def _lemma_owes_its_premises():
    def state(c):
        c.lemma("positive", x=c.real("x"))

    return _owes(state, "lemma")


def _lemma_is_known_only_where_it_holds():
    def state(c):
        x = c.real("x")
        c.lemma("positive", when=x > 0, x=x)
        c.show(x + 1 > 1)

    return not _owes(state, "lemma") and _owes(state, "goal")


def _positive(c):
    x = c.real("x")
    c.premise(x > 0)
    c.show(x + 1 > 1)


def _circular(c):
    c.lemma("circular")


LEMMAS = {"positive": _positive, "circular": _circular}


def _fold(c, *, start=0, model_start=0, relation=None, acc=None):
    c.fold(
        Fold("largest", "", tally, start, same_value),
        acc=c.whole("acc") if acc is None else acc,
        model=c.whole("model"),
        item=(c.integer("item"),),
        context=(),
        model_start=model_start,
        model_step=tally,
        model_finish=same_value,
        relation=relation or c.same,
    )


def _fold_kind(kind, **how):
    return lambda: _owes(lambda c: _fold(c, **how), kind)


def _fold_with_premise(c):
    acc = c.integer("acc")  # restricts it to 62 bits
    _fold(c, acc=acc)


CHECKS = {
    "a division by zero is owed": _undefined(half, "real", "real"),
    "a callee's division by zero is owed": _undefined(caller, "real", "real"),
    "a root of a negative is owed": _undefined(bare_root, "real"),
    "64 bits are owed": _undefined(product, "integer", "integer"),
    "a callee's 64 bits are owed": _undefined(product_of_callee, "integer", "integer"),
    "a shift's width is owed": _undefined(shifted, "mask", "mask"),
    "a root is known by its square": _root_is_known,
    "nothing else is known of a root": _root_is_not_overstated,
    "an opaque function looks at its arguments": _opaque_looks_at_arguments,
    "equal arguments give equal results": _opaque_is_a_function,
    "opaque namesakes are two functions": _opaque_namesakes_are_two,
    "a lemma owes its premises": _lemma_owes_its_premises,
    "a lemma holds where its condition does": _lemma_is_known_only_where_it_holds,
    "a fold owes its base": _fold_kind("base", start=1),
    "a fold owes its step": _fold_kind("step", relation=lambda a, b: a <= 5),
    "a fold owes its use": _fold_kind("use", relation=lambda a, b: a >= b),
    "a right fold is proved": lambda: not _owes(_fold, "base", "step", "use", "defined"),
    "a restricted accumulator is refused": _refused(_fold_with_premise),
    "a literal accumulator is refused": _refused(lambda c: _fold(c, acc=SymInt(z3.IntVal(0)))),
    "integers and reals do not mix": _refused(
        lambda c: c.use(bad_mix, c.integer("a"), c.real("b"))
    ),
    "a number is never a truth value": _refused(lambda c: c.use(bad_equality, c.real("a"))),
    "recursion is refused": _refused(lambda c: c.use(endless, c.real("a"))),
    "lemmas in a circle are refused": _refused(lambda c: c.lemma("circular")),
    "a lemma's value must exist": _refused(lambda c: c.lemma("positive", x=c.real("x"), y=1)),
    "a value is introduced once": _refused(lambda c: [c.real("x"), c.real("x")]),
}


@pytest.mark.parametrize("name", CHECKS)
def test_what_is_owed(name):
    assert CHECKS[name]()


# -- seeded defects of the lifter ---------------------------------------------------------------
def _nothing(*args, **more):
    return None


def _old_decider(context, queue, pruned):
    """Repeated conditions took part in a replay's script: whole paths were lost."""

    def decide(path, condition):
        index = len(path.taken)
        if index < len(path.script):
            choice = path.script[index]
        elif condition.get_id() in {c.get_id() for c in path.conditions}:
            return True
        else:
            yes = lifter._feasible([*context, *path.conditions, condition])
            no = lifter._feasible([*context, *path.conditions, z3.Not(condition)])
            choice = yes or not no
            if yes and no:
                queue.append([*path.taken, False])
        path.taken.append(choice)
        path.conditions.append(condition if choice else z3.Not(condition))
        return choice

    return decide


def _inverted(self):
    return not TRUTH(self)


def _rotated(branches):
    values = [v for _, v in branches]
    return JOIN([(c, v) for (c, _), v in zip(branches, values[1:] + values[:1], strict=True)])


def _without_calls(callee):
    return lambda *args: lift(callee, *args).value


def _one_result(self, *args):
    if not self.results:
        self.results[""] = claim_module._fresh(f"{self.name}#0", self.result)
        self.calls.append(args)
    return self.results[""]


def _new_result(self, *args):
    self.calls.append(args)
    return claim_module._fresh(f"{self.name}#{len(self.calls)}", self.result)


def _short_name(self, name, function):
    STUB(self, function.__name__, function)


def _owe_all_but(kind):
    def owe(self, other, text, goal):
        if other != kind:
            OWE(self, other, text, goal)

    return owe


def _rootless(value):
    before = symbolic.PATHS[-1].roots
    symbolic.PATHS[-1].roots = []
    made = ROOT(value)
    symbolic.PATHS[-1].roots = before
    return made


def _root_known_too_well(value):
    made = ROOT(value)
    symbolic.PATHS[-1].roots.append(made.term * made.term == symbolic._raw(value))
    return made


def _mixes(term):
    return z3.ToReal(term) if z3.is_int(term) else term


def _unequal(self, other):
    return NotImplemented if symbolic._pair(self, other) is None else EQUAL(self, other)


def _wrong_remainder(self, other):
    return symbolic.wrap(z3.If(self.term >= 0, self.term % other, -((-self.term) % other)))


def _hasty(conditions):
    """Takes `unknown` for infeasible, with next to no budget."""
    return len(conditions) < 2


TRUTH, JOIN, OWE, EQUAL = SymBool.__bool__, lifter.join, Claim._owe, SymNumber.__eq__
ROOT, STUB, EXTREME = symbolic.root, Stub.__init__, lifter._extreme
DECIDER, DIVIDE = lifter._decider, symbolic._divide

DEFECTS = {
    "decisions the wrong way round": [(SymBool, "__bool__", _inverted)],
    "a path dropped": [(lifter, "_decider", lambda c, q, p: DECIDER(c, [], p))],
    "paths lost where a condition repeats": [(lifter, "_decider", _old_decider)],
    "results joined in the wrong order": [(lifter, "join", _rotated)],
    "pruning what was not decided": [(lifter, "_feasible", _hasty)],
    "abs without its case": [(SymNumber, "__abs__", lambda self: self)],
    "min and max exchanged": [
        (lifter, "_extreme", lambda which: EXTREME(max if which is min else min))
    ],
    "<= taken for <": [(SymNumber, "__le__", SymNumber.__lt__)],
    "> taken for >=": [(SymNumber, "__gt__", SymNumber.__ge__)],
    "!= of truth values taken for ==": [(SymBool, "__ne__", SymBool.__eq__)],
    "a literal minus a value, turned": [(SymNumber, "__rsub__", SymNumber.__sub__)],
    "a quotient upside down": [(symbolic, "_divide", lambda a, b: DIVIDE(b, a))],
    "& taken for |": [(SymMask, "__and__", SymMask.__or__)],
    "a shift that keeps the sign": [
        (SymMask, "__rshift__", lambda self, other: SymMask(self.term >> self._with(other)))
    ],
    "a remainder that rounds to zero": [(SymInt, "__mod__", _wrong_remainder)],
    "no side conditions": [(Path, "require", _nothing)],
    "a callee's side conditions lost": [(lifter, "_calling", _without_calls)],
    "definedness not owed": [(Claim, "_owe", _owe_all_but("defined"))],
    "64 bits not owed": [(symbolic, "INT64", 2**200)],
    "a root of which nothing is known": [(lifter, "root", _rootless)],
    "a root of which too much is known": [(lifter, "root", _root_known_too_well)],
    "integers mixed with reals": [(symbolic, "as_real", _mixes)],
    "unequal because of another kind": [(SymNumber, "__eq__", _unequal)],
    "a stub that ignores its arguments": [(Stub, "__call__", _one_result)],
    "a stub that forgets": [(Stub, "__call__", _new_result)],
    "a stub named by half its name": [(Stub, "__init__", _short_name)],
    "a lemma for nothing": [(Claim, "_owe", _owe_all_but("lemma"))],
    "an induction without base": [(Claim, "_owe", _owe_all_but("base"))],
    "an induction without step": [(Claim, "_owe", _owe_all_but("step"))],
    "an induction without use": [(Claim, "_owe", _owe_all_but("use"))],
    "an induction over chosen accumulators": [(Claim, "_arbitrary", _nothing)],
}


def _noticed():
    """Comparisons and checks that notice something; a crash of the lifter is noticed as well."""
    found = []
    for function in [*PROBES, length, REGISTRY["vertical_violation"].function]:
        try:
            wrong = differences(function, 400)
        except Exception as error:
            wrong = [error]
        if wrong:
            found.append(function.__name__)
    for name, check in CHECKS.items():
        try:
            good = check()
        except Exception:
            good = False
        if not good:
            found.append(name)
    return found


def test_nothing_is_noticed_in_the_lifter_as_it_is():
    assert _noticed() == []


@pytest.mark.parametrize("name", DEFECTS)
def test_a_defect_of_the_lifter_is_noticed(name, monkeypatch):
    for owner, attribute, value in DEFECTS[name]:
        monkeypatch.setattr(owner, attribute, value)
    assert _noticed()


def test_paths_are_counted_and_dead_ones_pruned():
    def state(a: float) -> int:
        if a > 1:
            if a > 0:
                return 1
            return 2
        return 3

    lifted = lift(state, SymReal(z3.Real("a")))
    assert (lifted.paths, len(lifted.branches), lifted.pruned) == (2, 2, 1)


def test_values_that_cannot_be_joined_are_refused():
    def truth_or_number(a: float) -> float:
        if a > 1:
            return a
        return a > 0

    def nothing(a: float) -> float:
        if a > 1:
            return a
        return None

    for function in (truth_or_number, nothing):
        with pytest.raises(LiftError, match="cannot be joined"):
            lift(function, SymReal(z3.Real("a")))


def test_masks_stay_in_64_bits():
    for wrong in (-1, 2**64):
        with pytest.raises(LiftError, match="no mask"):
            SymMask(z3.BitVec("m", 64)) | wrong


# -- what a theorem is about, and what it offers ----------------------------------------------------
def _closed(c):
    c.opaque(callee)
    a, b = c.reals("a b")
    c.show(c.same(c.use(callee, a, b), c.use(callee, a, b)))


def _looking(c):
    a, b = c.reals("a b")
    c.premise(b == 1)
    c.step(b * b == 1, "on the way")
    c.show(c.use(callee, a, b) == a)


def test_a_theorem_is_about_what_it_or_a_lemma_looks_into(monkeypatch):
    for name, statement, about in (("closed", _closed, []), ("looking", _looking, ["callee"])):
        monkeypatch.setitem(LEMMAS, name, statement)
        own = Claim()
        statement(own)
        assert own.kernels == about
        caller_of_it = Claim(load=lambda name: LEMMAS[name])
        caller_of_it.opaque(callee)
        x, y = caller_of_it.reals("x y")
        caller_of_it.use(callee, x, y)
        caller_of_it.lemma(name, a=x, b=y)
        assert caller_of_it.kernels == about


def test_a_step_is_owed_and_known_but_not_offered(monkeypatch):
    monkeypatch.setitem(LEMMAS, "looking", _looking)
    own = Claim()
    _looking(own)
    assert [o.text for o in own.obligations if o.kind == "goal"] == ["on the way", "the claim"]
    assert all(_holds(o.given, o.goal) for o in own.obligations)
    user = Claim(load=lambda name: LEMMAS[name])
    x, y = user.reals("x y")
    user.lemma("looking", a=x, b=y)
    assert len(user.facts) == 1


def test_what_a_lemma_hides_stays_open_outside():
    def hides(c):
        c.opaque(callee)
        c.show(True)

    claim = Claim(load=lambda name: hides)
    claim.lemma("hides")
    assert claim.stubs == {}
