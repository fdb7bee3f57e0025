"""Attributes of the assignment service: what they mean, and that a wrong one is named."""

from __future__ import annotations

import pytest

from cratous.services.loading.assignment_attributes import (
    NO_LIMIT,
    NODES_PER_MS,
    Settings,
    settings_of,
)
from cratous.services.planning.assign import Limits, solve
from cratous.spec.assignment.search import AssignmentProblem, Choice
from cratous.spec.errors import BadInput


def test_attributes_mean_what_uxas_means_and_more() -> None:
    assert settings_of({}) == Settings(None, None, None)
    said = {"CostFunction": "CUMULATIVE", "NumberNodesMaximum": "0", "Semantics": "order"}
    assert settings_of(said) == Settings("CUMULATIVE", 0, "order")
    assert settings_of({"NumberNodesMaximum": "-1"}).nodes == NO_LIMIT
    assert settings_of({"Deadline_ms": "200"}).nodes == 200 * NODES_PER_MS
    assert settings_of({"Deadline_ms": "200", "NumberNodesMaximum": "7"}).nodes == 7


@pytest.mark.parametrize(
    "wrong",
    [
        {"CostFunction": "FASTEST"},
        {"NumberNodesMaximum": "many"},
        {"Deadline_ms": "0"},
        {"Semantics": "x"},
    ],
)
def test_a_wrong_attribute_is_named(wrong: dict[str, str]) -> None:
    with pytest.raises(BadInput) as error:
        settings_of(wrong, "cfg.xml")
    assert next(iter(wrong)) in str(error.value)
    assert "cfg.xml" in str(error.value)


def test_no_nodes_means_the_first_leaf() -> None:
    # the near task first is greedy and leaves the far one for the same vehicle
    choices = (Choice(1, 1, 1, (1,)), Choice(2, 1, 1, (1,)))
    problem = AssignmentProblem("", (1,), (0,), choices, (((None, 20), (2, None), (1, 4)),))
    best = solve(problem)
    first = solve(problem, Limits(nodes=0))
    assert best.cost == best.bound == 8
    assert first.cost == 23
    assert first.bound < 23
