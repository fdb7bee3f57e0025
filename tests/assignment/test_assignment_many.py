"""Problems with many options."""

from __future__ import annotations

import time

import numpy as np
import pytest

from cratous.services.planning.assign import Limits, solve, warm
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
