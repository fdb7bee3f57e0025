"""Problems with many options."""

from __future__ import annotations

import random
import time

import numpy as np
import pytest

from cratous.services.planning import assign
from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_warm import warm
from cratous.spec.assignment.search import AssignmentProblem, Choice


@pytest.mark.slow
def test_hundreds_of_options_do_not_slow_the_bound_down() -> None:
    """As many as example 06 of OpenUxAS has; asked pair by pair the bounds took minutes."""
    rng = np.random.default_rng(3)
    tasks, each, vehicles = 20, 25, 4
    count = tasks * each
    choices = tuple(
        Choice(1 + k // each, k, int(rng.integers(100, 300)), (1, 2, 3, 4)) for k in range(count)
    )
    rows = tuple(tuple(row) for row in rng.integers(50, 900, (count + 1, count)).tolist())
    p = AssignmentProblem("", (1, 2, 3, 4), (0,) * vehicles, choices, (rows,) * vehicles, "")
    warm()
    begun = time.process_time()
    found = solve(p, Limits(nodes=400_000, width=50_000))
    assert found.cost is not None
    assert found.nodes >= 400_000
    assert time.process_time() - begun < 20


def test_many_tasks_in_a_given_order_are_settled_by_a_narrow_search(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With the order given only the options are open: what improves many tasks at random has nothing to do."""
    rng = random.Random(3)
    choices = tuple(Choice(t, option, 5, (1,)) for t in range(1, 23) for option in (1, 2, 3))
    row = [[rng.randrange(1, 90) for _ in choices] for _ in range(len(choices) + 1)]
    order = " ".join(f"p{t}" for t in range(1, 23))
    p = AssignmentProblem("one", (1,), (0,), choices, (tuple(map(tuple, row)),), f".({order})")

    def never(*_given: object) -> None:
        raise AssertionError("it was settled before")

    monkeypatch.setattr(assign, "rebuilt", never)
    monkeypatch.setattr(assign, "repaired", never)
    found = solve(p)
    best = {3 * 22: 0}
    for t in range(22):
        best = {
            3 * t + o: min(cost + row[k][3 * t + o] + 5 for k, cost in best.items())
            for o in range(3)
        }
    assert found.bound == found.cost == min(best.values())
