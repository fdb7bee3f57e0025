"""Which uses of kernels a theorem's goals decide at many values: by runs with other results, and by the solver."""

from fractions import Fraction

import pytest

from cratous.core.algebra.steps import tasks_with
from cratous.core.kernel import qualified
from cratous.core.ledger import PRODUCT
from cratous.proofs.claim import Claim
from cratous.proofs.engine.reachable_paths import ALL
from cratous.proofs.engine.terms import free_names, known, leaves
from cratous.proofs.statements import decided, free_results, other_results
from cratous.proofs.statements.closed_definitions import full_name
from cratous.spec.algebra.operators import stands_in_one_of


def decides(x: float, n: int) -> bool:
    """Whatever."""
    return x > 0 or n > 0


def meant(x: float, n: int) -> bool:
    """The same."""
    return n > 0 or x > 0


def counts(x: float) -> bool:
    """True of one number."""
    return x == 3


def moved(x: float, n: int) -> float:
    """A number."""
    return x if n > 0 else x - 1


def at_most(x: float) -> float:
    """No less."""
    return 2 * x if x > 0 else x


class _Uses(Claim):
    """What a statement gives its uses of kernels."""

    def use(self, kernel, *args, when=True):
        self.given = [*getattr(self, "given", []), (kernel, args)]
        return super().use(kernel, *args, when=when)


def _by_runs(state, meaning=None) -> bool:
    return 0 in _found(state, meaning)[0]


def _found(state, meaning=None) -> tuple[set[int], bool]:
    claim = _Uses()
    state(claim)
    places = {
        n: (
            qualified(kernel),
            {(n, k): t for k, t in enumerate(map(known, leaves(args))) if free_names(t)},
        )
        for n, (kernel, args) in enumerate(claim.given)
    }
    meaning = full_name(meaning or meant)
    statement = other_results.Statement(state, places, meaning, frozenset())
    return other_results.decided(statement, "seed", 20_000, lambda found: 0 in found)


def _by_the_solver(state, meaning=None) -> bool:
    claim = free_results.FreeResults()
    state(claim)
    return free_results.decides(claim, 0, full_name(meaning or meant), decided._Asking())


GOALS = [
    (lambda c, x, n, said, wanted: c.same(said, wanted), True),
    (lambda c, x, n, said, wanted: c.implies(said, wanted), True),
    (lambda c, x, n, said, wanted: c.implies(x > 1, c.same(said, wanted)), True),
    (lambda c, x, n, said, wanted: c.implies(x == 3, c.same(said, wanted)), False),
    (lambda c, x, n, said, wanted: c.implies(x * x == 1, c.same(said, wanted)), False),
    (lambda c, x, n, said, wanted: c.implies(n == 3, c.same(said, wanted)), False),
    (lambda c, x, n, said, wanted: c.any_of(x != 3, c.same(said, wanted)), False),
    (lambda c, x, n, said, wanted: c.when(x == 3, c.same(said, wanted), x == x), False),
    (lambda c, x, n, said, wanted: c.implies(c.define(counts, x), c.same(said, wanted)), False),
    (
        lambda c, x, n, said, wanted: c.all_of(
            c.same(said, c.any_of(x > 0, n > 0)), c.same(wanted, wanted)
        ),
        False,
    ),
]


@pytest.mark.parametrize(("goal", "many"), GOALS)
def test_what_a_goal_decides(goal, many):
    def state(c: Claim) -> None:
        x, n = c.real("x"), c.integer("n")
        c.show(goal(c, x, n, c.use(decides, x, n), c.define(meant, x, n)))

    assert _by_runs(state) is many
    assert _by_the_solver(state) is many


@pytest.mark.parametrize(
    ("goal", "anywhere"),
    [
        (lambda c, said, wanted: c.same(said, said), False),
        (lambda c, said, wanted: c.same(said, wanted), True),
    ],
)
def test_it_is_told_whether_a_result_is_decided_anywhere(goal, anywhere):
    def state(c: Claim) -> None:
        x, n = c.real("x"), c.integer("n")
        c.show(goal(c, c.use(decides, x, n), c.define(meant, x, n)))

    assert _found(state) == ({0} if anywhere else set(), anywhere)


def test_premises_before_a_goal_restrict_it_and_those_after_do_not():
    def state(c: Claim, *, first: bool) -> None:
        x, n = c.real("x"), c.integer("n")
        goal = c.same(c.use(decides, x, n), c.define(meant, x, n))
        if first:
            c.premise(x * x == 1)
        c.show(goal)
        c.premise(x * x == 1)

    for first in (True, False):
        assert _by_runs(lambda c, first=first: state(c, first=first)) is not first
        assert _by_the_solver(lambda c, first=first: state(c, first=first)) is not first


def test_a_number_is_moved():
    def state(c: Claim) -> None:
        x, n = c.real("x"), c.integer("n")
        c.show(c.use(moved, x, n) <= c.define(at_most, x) + 1)

    assert _by_runs(state, at_most)
    assert _by_the_solver(state, at_most)


def test_another_definition_decides_nothing_for_this_one():
    def state(c: Claim) -> None:
        x, n = c.real("x"), c.integer("n")
        said = c.use(decides, x, n)
        c.show(c.same(said, c.define(meant, x, n)))
        c.show(c.implies(x == 3, c.same(said, c.define(counts, x))))

    assert _by_runs(state)
    assert not _by_runs(state, counts)
    assert not _by_the_solver(state, counts)


def test_two_uses_of_the_same_arguments_have_one_result():
    def state(c: Claim) -> None:
        x, n = c.real("x"), c.integer("n")
        one, other = c.use(decides, x, n), c.use(decides, x, n)
        wanted = c.define(meant, x, n)
        c.show(c.all_of(c.same(one, other), c.implies(x == 3, c.same(one, wanted))))

    assert not _by_runs(state)
    assert not _by_the_solver(state)


def test_a_run_whose_values_decide_too_little_is_followed_by_others(monkeypatch):
    theorem, use = "algebra_tasks_with_is_its_definition", (qualified(tasks_with), 0)
    group = (full_name(stands_in_one_of), {use: ALL})

    def found(seed: str) -> bool:
        return bool(decided.decided(theorem, PRODUCT.theorems, seed, [group]))

    assert found("seed37")
    monkeypatch.setattr(decided, "TRIES", 0)
    assert not found("seed37")


def test_other_values_are_of_the_same_type_and_differ():
    for value in (True, 3, Fraction(1, 3), (True, 2, (Fraction(1),))):
        others = list(other_results._others(value, "seed"))
        assert others
        assert value not in others
        assert {other_results._shape(other) for other in others} == {other_results._shape(value)}
