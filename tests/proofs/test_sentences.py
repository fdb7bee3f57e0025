"""Sentences that are made from what theorems state."""

from __future__ import annotations

import pytest
import z3

from cratous.core import ledger
from cratous.proofs.statements import sentences
from cratous.proofs.statements.relations import relations
from cratous.proofs.statements.sentences import Stated, sentence

STATED = {
    "schedule_later_and_earlier_are_their_definitions": (
        "for any integers a, b, t, then t <= later(a, b) exactly where spec.schedule.later_of(t, a, b); "
        "and t >= earlier(a, b) exactly where spec.schedule.earlier_of(t, a, b)"
    ),
    "tasks_enough_seen_is_its_definition": (
        "for any real numbers unseen, whole, part, given unseen >= 0 and whole >= 0, then if "
        "spec.geofence.part_seen(part, unseen, whole) then enough_seen(unseen, whole); and if "
        "enough_seen(unseen, whole) then spec.geofence.part_seen(whole - unseen, unseen, whole); and "
        "2 examples with known values hold"
    ),
}


@pytest.mark.parametrize("name", STATED)
def test_a_theorem_says_what_it_states(name: str) -> None:
    ledger.load_all()
    assert relations(name).statement == STATED[name]


def test_an_induction_says_over_what_it_runs_and_what_it_keeps() -> None:
    ledger.load_all()
    said = relations("authority_beats_in_time_is_its_definition").statement
    assert "by induction over the items (time) of beats_in_time" in said
    assert "if before an item last = model_last and" in said
    assert "then at the end beats_result((last, ok)) exactly where" in said


def _one(goal: z3.BoolRef, *given: z3.BoolRef) -> str:
    from cratous.proofs.engine.obligation import Obligation

    owed = Obligation("goal", "the author's words", given, goal)
    return sentence(
        Stated({"x": "integer", "y": "integer"}, {}, [owed], {0: given}, None, (), None)
    )


def test_a_weaker_statement_has_another_sentence() -> None:
    x, y = z3.Ints("x y")
    said = {
        _one(x < y), _one(x <= y), _one(x < y, x >= 0), _one(z3.Implies(x > 0, x < y)),
        _one(z3.Not(z3.And(x < y, y > 0))), _one(z3.Or(x < y, y > 0)),
    }  # fmt: skip
    assert len(said) == 6
    assert _one(x < y, z3.And(x >= 0, x <= 2**59)) == (
        "for any integers x, y, given x in [0, 2^59], then x < y"
    )
    assert _one((x + y) * 2 <= x - (y - 1)).endswith("then (x + y) * 2 <= x - (y - 1)")
    assert _one(z3.Not(z3.And(x < y, y > 0))).endswith("then not (x < y and y > 0)")


def test_what_is_cut_says_so() -> None:
    x = z3.Int("x")
    goal = z3.And(*[x > k for k in range(200)])
    said = _one(goal)
    assert "characters more)" in said
    assert len(said) < sentences.CLAUSE_MAX + 100
    every = sentences._listed([f"x > {k}" for k in range(50)], " and ")
    assert every.endswith(f"and {50 - sentences.CLAUSES_MAX} more")


def test_what_cannot_be_read_says_so() -> None:
    x = z3.Int("x")
    deep = x > 0
    for k in range(20_000):
        deep = z3.Or(z3.Not(deep), x > k)
    assert _one(deep) == sentences.UNREAD
    assert _one(z3.ForAll([x], x > 0)) == sentences.UNREAD
