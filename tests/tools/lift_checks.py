"""Functions that use every part of the kernel subset, and checks of what lifter and claims owe."""

from math import sqrt
from typing import NamedTuple

import z3

from cratous.core.kernel import Fold, named
from cratous.proofs.claim import Claim
from cratous.proofs.engine.lift import LiftError
from cratous.proofs.engine.symbolic import SymInt
from cratous.spec import well_clear


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
        kernel = named("horizontal_violation").function
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
