"""Every proof is run: a prover that says yes to everything is found out, and so are other readings."""

from __future__ import annotations

import math
import operator
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.kernel import named
from cratous.core.ledger import load_all
from cratous.proofs import ledger
from cratous.proofs.engine import prover
from cratous.proofs.engine.prover import Outcome, Owed, restore
from cratous.proofs.engine.theorem_files import load_claim
from cratous.proofs.ledger.report_formats import failure_text
from cratous.proofs.running.arguments import rows
from cratous.proofs.running.copies import Undecided, rational_root
from cratous.proofs.running.readings import DOUBLES, MACHINE, TERM, compare
from cratous.proofs.running.statement import False_, OnNumbers, Outside, Values
from cratous.proofs.running.tracked import Rounded, Tracked
from cratous.spec.contracts import tasks

load_all()
HEAD = '''"""What is claimed."""

from cratous.core.geofence.planar import straddles
from cratous.core.schedule.rows import later
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
'''
FALSE = {
    "a_goal": """    best, value = c.integer("best"), c.integer("value")
    c.show(c.use(later, best, value) > best)
""",
    "a_case": """    best, value = c.integer("best"), c.integer("value")
    c.cases(best < value, value < best, goal=c.use(later, best, value) >= best)
""",
    "a_conclusion": """    best, value = c.integer("best"), c.integer("value")
    c.show(c.implies(value > best + 1000, c.same(c.use(later, best, value), best)))
""",
}
INDUCTIONS = {
    "along_items": """    item = (c.real("x"), c.real("y"))
    along_items(
        c, [(Fold("sum", "", lambda acc, x, y: acc + x, 0), c.real("acc"), ())], item=(item, True),
        invariant=lambda a: a[0] >= 0, goal=lambda r: r[0] >= 0, text="sums",
    )
""",
    "a_closed_chain": """    closed_chain(
        c, [(Fold("turns", "", lambda acc, a, b: acc + 1, 0), c.integer("acc"), ())],
        invariant=lambda a, first, last: a[0] >= 0, edge=lambda a, b: None,
        goal=lambda r: r[0] <= 2, text="edges",
    )
""",
    "a_term": """    every_term(
        c, task=(1, 1), none=(0, 0), so_far=(c.integer("n"), c.integer("m")),
        operand=(c.integer("k"), c.integer("l")),
        add=(lambda n, k: n + k, lambda m, l: m + l), whole=(lambda n: n, lambda m: m + 1),
        related=c.same, alike=c.same, node=(), text="sizes",
    )
""",
}
INDUCTION_HEAD = HEAD.replace(
    "from cratous.proofs.claim import Claim\n",
    "from cratous.core.kernel import Fold\nfrom cratous.proofs.claim import Claim\n"
    "from cratous.proofs.methods.chains import closed_chain\n"
    "from cratous.proofs.methods.runs import along_items\n"
    "from cratous.proofs.methods.terms import every_term\n",
)
TRUE = """    best, value = c.integer("best"), c.integer("value")
    c.premise(value >= best)
    c.show(c.same(c.use(later, best, value), value))
"""


def _yes(claim, obligation, *rest):
    return Outcome(Owed(obligation.kind, obligation.text), "proved", 1, "ALL")


@pytest.mark.parametrize("name", FALSE)
def test_what_a_prover_wrongly_proves_is_false_when_it_is_run(name, tmp_path: Path, monkeypatch):
    (tmp_path / f"{name}.py").write_text(HEAD + FALSE[name])
    monkeypatch.setattr(prover, "_decide", _yes)
    (theorem,) = ledger.prove_theorems([name], folder=tmp_path, jobs=1, machine=False)
    assert all(outcome.status == "proved" for outcome in theorem.outcomes)
    assert not theorem.proved
    assert "run as Python" in failure_text(theorem)
    assert "best = " in failure_text(theorem)


@pytest.mark.parametrize("name", INDUCTIONS)
def test_an_induction_that_does_not_hold_is_false_when_it_is_run(name, tmp_path: Path):
    (tmp_path / f"{name}.py").write_text(INDUCTION_HEAD + INDUCTIONS[name])
    statement = load_claim(name, tmp_path)[0]

    def tried(number: int) -> bool:
        on = OnNumbers(Values({}, f"{name} {number}"), lambda other: lambda c: None)
        try:
            statement(on)
        except False_:
            return True
        return False

    assert sum(map(tried, range(40))) >= 5


def test_an_open_value_takes_the_number_that_a_premise_gives_it():
    for seed in range(20):
        on = OnNumbers(Values({}, f"{seed}"), lambda name: lambda c: None)
        x, y, z, w = on.reals("x y z w")
        on.premise(3 * (x - 1) == 7 - y)
        on.premise(on.all_of(y < z, z + 1 >= w))
        assert 3 * (x.number() - 1) == 7 - y.number()
        assert y.number() <= z.number()
        assert z.number() + 1 >= w.number()
        with pytest.raises(Outside):
            on.premise(3 * x == 11 - y)  # they have their numbers


def test_only_a_premise_makes_a_statement_true():
    """A goal, a condition and the premise of a lemma about open values are asked, not granted."""
    held = []
    for seed in range(40):
        on = OnNumbers(Values({}, f"{seed}"), lambda name: lambda c: c.premise(c.real("x") == 0))
        try:
            on.show(on.real("x") == 5)
        except False_:
            held.append(False)
        else:
            held.append(True)
        with pytest.raises(False_, match="premise of the lemma any"):
            on.lemma("any", x=on.real("y") + Fraction(1, 2) + 1000)
        assert on.when(on.real("z") == 77, 1, 2) == 2
    assert not all(held)


def test_a_true_theorem_is_run_at_some_points_and_kept_with_them(tmp_path: Path):
    (tmp_path / "fine.py").write_text(HEAD + TRUE)
    (theorem,) = ledger.prove_theorems(["fine"], folder=tmp_path, jobs=1)
    assert theorem.proved
    assert theorem.ran is not None
    assert theorem.ran.points > 5
    assert theorem.ran.differences == theorem.ran.left_out == ()
    data = {key: value for key, value in asdict(theorem).items() if key != "_key"}
    assert restore(data).ran == theorem.ran


@pytest.mark.parametrize("name", ["later", "straddles", "vertical_interval", "orient"])
def test_the_readings_of_kernels_agree(name):
    found = compare(named(name).function)
    assert found.differences == ()
    assert found.left_out == ()
    assert dict(found.readings)[MACHINE] > 20


def test_special_numbers_are_among_the_arguments():
    function = named("later").function
    values = {value for row in rows(function, frozenset()) for value in row}
    assert {0, 1, -1, 2**53, 2**53 + 1, 2**53 - 1} <= values
    assert any(a == b for a, b in rows(function, frozenset()))


def test_arguments_of_theorems_are_made_doubles():
    function = named("vertical_interval").function
    size = len(rows(function, frozenset())[0])
    given = ((Fraction(2**53 + 1),) * size, (Fraction(10) ** 400,) * size, (Fraction(1),))
    assert rows(function, frozenset(), given)[-1] == (float(2**53),) * size
    assert compare(function, more=given, machine=False).differences == ()


doubles = st.floats(-1e12, 1e12) | st.integers(-20, 20).map(float)
operations = st.sampled_from([operator.add, operator.sub, operator.mul, operator.truediv])


@given(doubles, doubles, doubles, operations, operations)
def test_where_nothing_is_rounded_doubles_are_the_rationals(a, b, c, one, other):
    try:
        wanted = other(one(*(Tracked(Fraction(x)) for x in (a, b))), Tracked(Fraction(c))).value
    except (Rounded, ZeroDivisionError):
        return
    assert Fraction(other(one(a, b), c)) == wanted


def test_a_tracked_number_notices_rounding():
    with pytest.raises(Rounded):
        Tracked(Fraction(1)) / 3
    with pytest.raises(Rounded):
        Tracked(Fraction(2**53)) + (2**53 + 1)
    assert (Tracked(Fraction(2**53)) == 2**53 + 1) is False


@given(st.fractions(0, 1000))
def test_a_rational_root_is_exact_or_none(value):
    assert rational_root(value * value) == value
    with pytest.raises(Undecided):
        rational_root(value * value + Fraction(1, 10**9 + 7))
    with pytest.raises(ValueError, match="domain"):
        rational_root(-1 - value)


def _on(**point) -> OnNumbers:
    return OnNumbers(Values(point, "a seed"), lambda name: lambda c: c.premise(c.real("x") > 2))


def test_premises_and_goals_mean_on_numbers_what_they_say():
    on = _on(x=Fraction(1), y=Fraction(2))
    x, y = on.reals("x y")
    on.premise(x < y)
    on.show(on.implies(x > y, False))
    on.show(on.all_of(x < y, on.negation(x == y)))
    on.show(on.same(on.when(x < y, x, y), 1))
    with pytest.raises(Outside):
        on.premise(x > y)
    with pytest.raises(False_, match="'the claim' is false"):
        on.show(x == y)
    with pytest.raises(False_, match="cover everything"):
        on.cases(x > y, x == y, goal=True)
    on.lemma("any", when=x > y, x=x)
    with pytest.raises(False_, match="premise of the lemma any"):
        on.lemma("any", x=x)
    on.lemma("any", x=x + y)


def test_a_function_that_is_not_defined_where_it_is_used_is_a_difference():
    with pytest.raises(False_, match="not defined"):
        _on().define(lambda x: math.sqrt(x), Fraction(-1))


def test_the_table_of_task_states_is_compared() -> None:
    found = compare(tasks.row)
    assert found.left_out == found.differences == ()
    assert {name for name, _ in found.readings} == {TERM, DOUBLES}
