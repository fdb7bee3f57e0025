"""Which branches are possible: taken from models found before where one holds, else asked; never the contrary."""

from __future__ import annotations

import z3

from cratous.proofs.engine import lift, models

x, y = z3.Reals("x y")


def _model(*conditions: z3.BoolRef) -> z3.ModelRef:
    solver = z3.Solver()
    solver.add(*conditions)
    assert solver.check() == z3.sat
    return solver.model()


def test_a_model_answers_only_what_it_satisfies():
    kept = models.Models()
    assert not kept.satisfy([x == x + 0])  # none is kept
    kept.keep(_model(x == 2, y == 3))
    assert kept.satisfy([x < y, x * x == 4])
    assert kept.satisfy([x < y, z3.Real("not met before") + 1 > z3.Real("not met before")])
    assert not kept.satisfy([x < y, x > y])
    assert not kept.satisfy([x > y])  # possible, but not there


def test_models_of_irrational_and_of_long_numbers_are_not_kept():
    kept = models.Models()
    kept.keep(_model(x * x == 2))
    assert not kept.satisfy([x == x + 0])
    kept.keep(_model(x == z3.RealVal(3) / 10**models.DIGITS))
    assert not kept.satisfy([x == x + 0])


def test_the_latest_are_kept():
    kept = models.Models()
    for number in range(models.MOST + 1):
        kept.keep(_model(x == number))
    assert not kept.satisfy([x == 0])
    assert kept.satisfy([x == 1])
    kept.keep(_model(x == -1))
    assert kept.satisfy([x == 1])  # one that served stays the longest
    assert not kept.satisfy([x == 2])


def test_a_branch_is_impossible_only_where_the_solver_says_so(monkeypatch):
    monkeypatch.setattr(lift, "_ASKED", {})
    a, b = z3.Reals("a b")
    for _ in range(2):  # the second time there is a model
        assert lift._feasible([a < b, a > 0])
        assert not lift._feasible([a < b, a > b])
        assert lift._feasible([a < b, a < 0])
        lift._ASKED.clear()
    assert not lift._feasible([a * b > 2, a * b < 1])


def test_what_a_model_satisfies_is_not_asked(monkeypatch):
    monkeypatch.setattr(lift, "_ASKED", {})
    monkeypatch.setattr(lift, "_MODELS", models.Models())
    lift._MODELS.keep(_model(x == 2, y == 3))
    monkeypatch.setattr(lift.z3, "Solver", None)
    assert lift._feasible([x < y, x + y == 5])


def test_after_an_interrupt_no_model_answers():
    kept = models.Models()
    kept.keep(_model(x == 2, y == 3))
    z3.main_ctx().interrupt()
    assert not kept.satisfy([x * x + y > 6])
    solver = z3.Solver()
    solver.add(x * x + y > 6)
    assert solver.check() == z3.sat  # a question ends the interruption
    assert kept.satisfy([x * x + y > 6])
