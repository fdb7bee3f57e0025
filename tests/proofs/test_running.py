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
from cratous.proofs.ledger.formats import failure_text
from cratous.proofs.running.arguments import rows
from cratous.proofs.running.copies import Undecided, rational_root
from cratous.proofs.running.readings import MACHINE, compare
from cratous.proofs.running.statement import False_, OnNumbers, Outside, Values
from cratous.proofs.running.tracked import Rounded, Tracked

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
