"""Random terms with timing against a brute force that is written from the meaning of the terms."""

from __future__ import annotations

import pytest
from assignment_cases import least_below, problem
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_replay import replayed
from cratous.spec.assignment import ORDER, AssignmentProblem
from cratous.spec.errors import BadInput

HORIZON = 24
"""Beyond this no small problem starts anything: windows end at 19, and all together take less."""


def differs(p: AssignmentProblem) -> str:
    """What is wrong with the answer to a problem; nothing if it is right."""
    try:
        found = solve(p, Limits(nodes=200_000))
    except BadInput as error:
        return "" if "eligible" in str(error) else str(error)
    if found.cost is None:
        if found.status != "infeasible":
            return f"{p.name}: {found.status}"
        truth = least_below(p, HORIZON)
        return "" if truth is None else f"{p.name}: {truth} exists, said infeasible"
    if replayed(p, found.steps) != found.cost:
        return f"{p.name}: the cost is another"
    if found.bound > found.cost:
        return f"{p.name}: the bound {found.bound} is above the cost {found.cost}"
    truth = least_below(p, found.cost)
    return "" if truth is None else f"{p.name}: {truth} exists, {found.cost} said"


@settings(max_examples=150)
@given(st.integers(0, 2**32))
def test_terms_with_timing_are_solved_to_the_optimum(seed: int) -> None:
    assert differs(problem(seed, most=3)) == ""


@settings(max_examples=100)
@given(st.integers(0, 2**32))
def test_order_only_is_solved_to_the_optimum(seed: int) -> None:
    assert differs(problem(seed, timed=False, semantics=ORDER)) == ""


@pytest.mark.slow
@pytest.mark.parametrize("part", range(20))
def test_thousands_of_terms(part: int) -> None:
    wrong = []
    for k in range(500):
        seed = 1_000_000 + 500 * part + k
        timed = k % 4 != 0
        case = problem(seed, timed, ORDER if k % 8 == 0 else "time", 3 if timed else 4)
        wrong.append(differs(case))
    assert [w for w in wrong if w] == []
