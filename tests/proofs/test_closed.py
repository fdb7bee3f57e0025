"""What a theorem owes where it does not look into a function, and what its premises leave of arguments."""

from math import sqrt
from unittest.mock import patch

import pytest
import z3

from cratous.core.daa import coordination
from cratous.core.kernel import qualified
from cratous.proofs.claim import Claim
from cratous.proofs.engine import closed, reachable_paths
from cratous.proofs.engine.cache import Cache
from cratous.proofs.engine.counterexample import Watched
from cratous.proofs.engine.prover import _Memory, _satisfiable
from cratous.spec.daa import coordination as daa_coordination
from cratous.spec.well_clear import Plane


def inverse(x: float) -> float:
    """Not at 0."""
    return 1 / x


def total(x: float) -> float:
    """Everywhere."""
    return 1 / (x * x + 1) + sqrt(x * x - x + 1)


def of_both(x: float) -> float:
    """Total, but for one that is not."""
    return total(x) + inverse(x)


def guarded(x: float) -> float:
    """Calls the inverse of what is not 0 alone."""
    if x == 0:
        return x
    return inverse(x)


def two(x: float, n: int) -> bool:
    """Whatever."""
    return x > n * 0 or n > 3


@pytest.mark.parametrize(
    ("function", "count"), [(inverse, None), (total, 2), (of_both, None), (guarded, 1)]
)
def test_what_is_owed_everywhere(function, count):
    found = closed.everywhere(function, machine=True)
    assert (None if found is None else len(found.owed)) == count


def _owed(state) -> list[tuple[str, bool]]:
    """What a claim owes for the calls of closed functions, and whether it holds."""
    claim = Claim()
    state(claim)
    before = len(claim.obligations)
    claim.settle()
    claim.settle()
    found = []
    for one in claim.obligations[before:]:
        solver = z3.Solver()
        solver.add(*one.given, z3.Not(one.goal))
        found.append((one.text, solver.check() == z3.unsat))
    return found


def test_a_call_owes_what_the_function_owes_there():
    def state(c: Claim) -> None:
        x = c.real("x")
        c.opaque(inverse, total)
        c.define(guarded, x)
        c.define(inverse, x)
        c.premise(x > 1)
        c.define(inverse, x - 1)
        c.define(total, x)

    zero = "inverse, which is closed: no division by zero"
    everywhere = "total, which is closed: it is defined everywhere"
    assert sorted(_owed(state)) == sorted(
        [(zero, True), (zero, False), (zero, True), (everywhere, True)]
    )


def test_where_a_use_does_not_count_it_owes_nothing():
    def state(c: Claim) -> None:
        x = c.real("x")
        c.opaque(inverse)
        c.use(inverse, x, when=x > 1)

    assert [holds for _, holds in _owed(state)] == [True]


def test_what_a_lemma_looks_into_it_has_shown_under_its_premises():
    def lemma(c: Claim) -> None:
        x = c.real("x")
        c.premise(x != 0)
        c.show(c.use(inverse, x) * x == 1)

    def state(c: Claim, **how: object) -> None:
        x, y = c.real("x"), c.real("y")
        c.opaque(inverse)
        c.load = lambda name: lemma
        c.use(inverse, x)
        c.lemma("of it", x=y if how.get("other") else x, when=how.get("when", True))

    assert _owed(state) == []
    assert [holds for _, holds in _owed(lambda c: state(c, other=True))] == [False]
    assert [holds for _, holds in _owed(lambda c: state(c, when=False))] == [False]


def _how(state) -> list[str]:
    claim, memory = Watched(), _Memory(Cache(None))
    state(claim)
    ask = lambda terms: _satisfiable(terms, 100_000, memory)  # noqa: E731
    with patch.object(reachable_paths, "_beside_their_definitions", lambda claim: VOUCHED):
        return [
            how for _, how in reachable_paths.varied(claim, reachable_paths.Asked(ask, _another))
        ]


def test_of_a_kernel_whose_definition_is_not_there_nothing_is_asked():
    def refuse(*asked):
        raise AssertionError(asked)

    def state(c: Claim) -> None:
        s, v = c.vector("s"), c.vector("v")
        c.premise(s.x * s.x <= 4)
        c.use(coordination.horizontal_side, s, v)

    claim = Watched()
    state(claim)
    ask = reachable_paths.Asked(refuse, refuse)
    assert [how for _, how in reachable_paths.varied(claim, ask)] == [reachable_paths.NOT]
    claim.define(daa_coordination.horizontal_side, Plane(1, 2), Plane(2, 3))
    with pytest.raises(AssertionError):
        reachable_paths.varied(claim, ask)


def _another(terms, value):
    solver = z3.Solver()
    solver.add(*terms)
    return solver.model().eval(value, model_completion=True) if solver.check() == z3.sat else None


def test_how_arguments_vary():
    def state(c: Claim) -> None:
        x, n = c.real("x"), c.integer("n")
        c.use(two, x, n)
        c.use(two, x, 3)
        c.use(two, 3, n)
        c.use(two, x - x, n)
        c.premise(n * n <= 0)

    assert _how(state) == [reachable_paths.NOT, "3", reachable_paths.NOT, reachable_paths.NOT]
    assert _how(lambda c: c.use(two, c.real("x"), c.integer("n"))) == [reachable_paths.ALL]


@pytest.mark.parametrize(
    ("premise", "how"),
    [
        (lambda c, x, n: x * x == 1, "not 2"),
        (lambda c, x, n: x * x * x == x, "not 3"),
        (lambda c, x, n: x * (2**70 * x - 1) == 0, "not 2"),
        (lambda c, x, n: c.all_of(x >= 0, x <= 1), "all"),
        (lambda c, x, n: x * x <= 4, "all"),
        (lambda c, x, n: 2**60 * x * x <= 1, "all"),
        (lambda c, x, n: n * n == 4, "not 2"),
        (lambda c, x, n: c.all_of(n >= 0, n <= 1), "all"),
        (lambda c, x, n: c.all_of(n >= 0, n <= 3), "all"),
    ],
)
def test_a_few_values_of_an_argument_are_told_from_many(premise, how):
    def state(c: Claim) -> None:
        x, n = c.real("x"), c.integer("n")
        c.premise(premise(c, x, n))
        c.use(two, x, n)

    assert _how(state) == [how]


def masked(mask: int) -> bool:
    """Whatever."""
    return mask & 1 == 0


VOUCHED = {qualified(two), qualified(masked)}


def test_a_mask_takes_more_than_a_few_values():
    def state(c: Claim, most: int) -> None:
        mask = c.mask("mask")
        c.premise(mask & c.bits(2**64 - 1 - most) == c.bits(0))
        c.use(masked, mask)

    assert [_how(lambda c, most=most: state(c, most)) for most in (7, 15)] == [["not 8"], ["all"]]


@pytest.mark.parametrize(
    ("how", "more"),
    [
        ([], False),
        (["not", "all"], True),
        (["not 2"], False),
        (["not 2", "not 3"], False),
        (["3"], False),
        (["3", "3"], False),
        (["3", "4"], True),
        (["3, 1", "4, 1"], False),
        (["3, 1", "4, 2"], True),
    ],
)
def test_more_than_one_value(how, more):
    assert reachable_paths.of_more_than_one(how) is more
