"""Attributes of the assignment service: what they mean, and that a wrong one is named."""

from __future__ import annotations

import pytest

from cratous.core.assignment import START, Branch, Candidate, Problem, assign
from cratous.services.loading.assignment_attributes import (
    NO_LIMIT,
    NODES_PER_MS,
    Settings,
    settings_of,
)
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
    ways = {(0, START, 0): 1, (0, START, 1): 4, (0, 0, 1): 20, (0, 1, 0): 2}
    both = Branch((1, 2), (), lambda done: {1, 2} - set(done))
    options = (Candidate(1, 1, 1, 1, 1), Candidate(2, 1, 1, 1, 1))
    problem = Problem((0,), options, lambda v, a, b: ways.get((v, a, b)), {1: 1, 2: 1}, (both,))
    best = assign(problem)
    first = assign(Problem(**{**vars(problem), "node_limit": 0}))
    assert best.cost == 8
    assert first.cost == 23
    assert not first.exhausted
