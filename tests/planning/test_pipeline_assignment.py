"""The assignment service alone: what options and costs of messages it is told decide."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import cost, ended, matrix, option, options, unique
from pipeline_tools import Rig, alone, must_fly, vehicle

from cratous.bridge import lmcp
from cratous.services.planning import assign_problem
from cratous.spec import algebra
from cratous.spec.algebra import meaning as algebra_meaning

ASSIGNMENT = "AssignmentTreeBranchBoundService"
FIRST_PLAN_NODES = 80


assigner = alone(ASSIGNMENT)


@pytest.mark.shows(
    ASSIGNMENT,
    "UniqueAutomationRequest",
    "TaskPlanOptions",
    "AssignmentCostMatrix",
    "TaskAssignmentSummary",
)
def test_options_and_costs_of_messages_alone_decide(assigner: Rig) -> None:
    """Options that no service of this process has computed, as another's tasks may send them."""
    assigner.tell(
        unique(2, 5, 6, vehicles=(1, 2)),
        options(2, 5, option(5, 31, 1, cost=10_000), option(5, 32, 2, cost=20_000)),
        options(2, 6, option(6, 1, 1, 2, cost=5_000)),
        matrix(
            2,
            cost(1, 5, 31, 1_000),
            cost(2, 5, 32, 1_000),
            cost(1, 6, 1, 50_000),
            cost(2, 6, 1, 2_000),
            cost(1, 6, 1, 50_000, (5, 31)),
        ),
    )
    (summary,) = assigner.got("TaskAssignmentSummary")
    made = {
        t.TaskID: (t.AssignedVehicle, t.OptionID, t.TimeTaskCompleted) for t in summary.TaskList
    }
    assert made == {5: (1, 31, 11_000), 6: (2, 1, 7_000)}


def test_ineligible_and_excluded_vehicles_get_nothing_whatever_rows_there_are(
    assigner: Rig,
) -> None:
    assigner.tell(
        unique(2, 5, vehicles=(1,)),
        options(2, 5, option(5, 1, 1, cost=9_000)),
        matrix(2, cost(1, 5, 1, 90_000), cost(2, 5, 1, 1)),  # vehicle 2 is not in the request
    )
    (summary,) = assigner.got("TaskAssignmentSummary")
    assert [t.AssignedVehicle for t in summary.TaskList] == [1]
    assert "take no part" in assigner.reasons("Warning")[0]
    assigner.tell(
        unique(3, 5, vehicles=(1, 2)),
        options(3, 5, option(5, 1, 1, cost=9_000)),
        matrix(3, cost(1, 5, 1, 90_000), cost(2, 5, 1, 1)),  # vehicle 2 is not eligible
    )
    assert [t.AssignedVehicle for t in assigner.got("TaskAssignmentSummary")[1].TaskList] == [1]


@pytest.mark.parametrize(
    ("told", "rows", "words"),
    [
        (
            options(2, 5, option(5, 1, 1), composition="+(p1 p9)"),
            [],
            "no composition of the options",
        ),
        (
            options(2, 5, option(5, 1, 1), option(5, 2, 1), composition=".(p1 p1 p2)"),
            [],
            "p1 stands twice in one branch",
        ),
        (
            options(2, 5, option(5, 1, 1), option(5, 2, 1), composition=".(p1 p2)"),
            [cost(1, 5, 1, 5)],
            r"the costs have no way to task 5 \(option 2\)",
        ),
        (
            options(2, 5, option(5, 1, 1), composition="+(1)"),
            [],
            "Composition|composition|expected",
        ),
        (options(2, 5, option(5, 1, 1), composition="p1 |(p1"), [], "expected"),
        (options(2, 5, option(5, 1, 1)), [cost(1, 5, 8, 1)], "no such route between options"),
        (options(2, 5, option(5, 1, 1)), [cost(1, 5, 1, -4)], "no time below 0"),
        (options(2, 5, option(5, 1, 1, cost=-1)), [cost(1, 5, 1, 4)], "Cost of 0 ms or more"),
        (options(2, 5, option(5, 1, 1)), [], "the costs have no way to task 5"),
        (options(2, 5), [], "task 5"),
    ],
)
@pytest.mark.shows(ASSIGNMENT, "ServiceStatus")
def test_what_cannot_be_assigned_is_answered_with_the_reason(
    assigner: Rig, told: Any, rows: list[Any], words: str
) -> None:
    import re

    assigner.tell(unique(2, 5), told, matrix(2, *rows))
    assert not assigner.got("TaskAssignmentSummary")
    errors = [b for b in assigner.got("ServiceStatus") if b.StatusType.name == "Error"]
    (error,) = errors
    facts = {pair.Key: pair.Value for pair in error.Info}
    assert facts["RequestID"] == "2"
    assert re.search(words, " ".join(assigner.reasons())), assigner.reasons()
    assert not assigner.said.has("fails at")


@pytest.mark.shows(ASSIGNMENT, "CostFunction")
@pytest.mark.parametrize(
    ("function", "made"), [("MINMAX", {5: 1, 6: 2}), ("CUMULATIVE", {5: 1, 6: 1})]
)
def test_the_cost_function_decides(tmp_path: Path, function: str, made: dict[int, int]) -> None:
    rig = Rig(tmp_path, ASSIGNMENT, **{ASSIGNMENT: f'CostFunction="{function}"'})
    rig.tell(
        *vehicle(1),
        *vehicle(2, 0.01),
        must_fly(5),
        must_fly(6),
        unique(2, 5, 6, vehicles=(1, 2)),
        options(2, 5, option(5, 1, 1, cost=10_000)),
        options(2, 6, option(6, 1, 1, 2, cost=10_000)),
        matrix(
            2,
            cost(1, 5, 1, 1_000),
            cost(1, 6, 1, 1_000, (5, 1)),
            cost(1, 6, 1, 90_000),
            cost(2, 6, 1, 8_000),
        ),
    )
    (summary,) = rig.got("TaskAssignmentSummary")
    assert {t.TaskID: t.AssignedVehicle for t in summary.TaskList} == made


@pytest.mark.shows(ASSIGNMENT, "Semantics")
@pytest.mark.parametrize(("semantics", "waits"), [("time", True), ("order", False)])
def test_the_semantics_decide_whether_a_dot_is_about_time(
    tmp_path: Path, semantics: str, waits: bool
) -> None:
    rig = Rig(tmp_path, ASSIGNMENT, **{ASSIGNMENT: f'Semantics="{semantics}"'})
    rig.tell(
        *vehicle(1),
        *vehicle(2, 0.01),
        must_fly(5),
        must_fly(6),
        unique(2, 5, 6, vehicles=(1, 2), TaskRelationships=".(p5 p6)"),
        options(2, 5, option(5, 1, 1)),
        options(2, 6, option(6, 1, 2)),
        matrix(2, cost(1, 5, 1, 500_000), cost(2, 6, 1, 1_000)),
    )
    (summary,) = rig.got("TaskAssignmentSummary")
    ended = {t.TaskID: t.TimeTaskCompleted for t in summary.TaskList}
    assert (ended[6] > ended[5]) is waits


@pytest.mark.shows(ASSIGNMENT, "NumberNodesMaximum", "Deadline_ms")
@pytest.mark.parametrize(
    ("limit", "most"),
    [('NumberNodesMaximum="3"', 3), ('Deadline_ms="1"', 100), ('NumberNodesMaximum="-1"', None)],
)
def test_the_search_keeps_its_limit(tmp_path: Path, limit: str, most: int | None) -> None:
    """Beyond the first plan, which is made in any case, and one round that improves it."""
    rig = Rig(tmp_path, ASSIGNMENT, **{ASSIGNMENT: limit})
    rng, tasks = random.Random(4), range(5, 13)
    rows = [
        cost(v, task, 1, rng.randrange(1_000, 90_000), start)
        for v in (1, 2)
        for task in tasks
        for start in [(0, 0), *((other, 1) for other in tasks if other != task)]
    ]
    rig.tell(*vehicle(1), *vehicle(2, 0.01), *map(must_fly, tasks))
    rig.tell(unique(2, *tasks, vehicles=(1, 2)))
    rig.tell(*(options(2, task, option(task, 1, 1, 2)) for task in tasks), matrix(2, *rows))
    assert len(rig.got("TaskAssignmentSummary")) == 1
    told = [{p.Key: p.Value for p in body.Info} for body in rig.got("ServiceStatus")]
    (facts,) = [found for found in told if "nodes" in found]
    assert facts["status"] == ("optimal" if most is None else "feasible")
    assert most is None or int(facts["nodes"]) <= most + FIRST_PLAN_NODES


@pytest.mark.shows(ASSIGNMENT, "UniqueAutomationResponse", "ServiceStatus")
def test_a_request_that_has_ended_is_not_assigned_any_more(assigner: Rig) -> None:
    for number, end in ((2, lmcp.new("UniqueAutomationResponse", ResponseID=2)), (3, ended(3))):
        assigner.tell(unique(number, 5), options(number, 5, option(5, 1, 1)), end)
        assigner.tell(matrix(number, cost(1, 5, 1, 4)))
    assert not assigner.got("TaskAssignmentSummary")


def test_what_the_original_was_asked_is_answered_once_each(shared: Path, tmp_path: Path) -> None:
    """Relations and compositions that the original crashes at, ignores or misreads."""
    cases = json.loads((shared / "vectors/openuxas/algebra/service_cases.json").read_text())
    rig = Rig(tmp_path, ASSIGNMENT)
    rig.tell(*vehicle(1), *[must_fly(n, 0.02 + 0.01 * n) for n in (1, 2, 3)])
    rows = [cost(1, n, 1, 1_000) for n in (1, 2, 3)]
    rows += [cost(1, b, 1, 1_000, (a, 1)) for a in (1, 2, 3) for b in (1, 2, 3) if a != b]
    assert len(cases) > 30
    for number, case in enumerate(cases, 1):
        rig.all.clear()
        text, compositions = case["TaskRelationships"], case["Compositions"]
        rig.tell(unique(number, 1, 2, 3, TaskRelationships=text))
        for task, composition in compositions.items():
            told = options(number, int(task), option(int(task), 1, 1), composition="x")
            rig.tell(told.copy(Composition=composition))
        rig.tell(matrix(number, *rows))
        summaries, errors = rig.got("TaskAssignmentSummary"), rig.reasons()
        assert len(summaries) + bool(errors) == 1, (text, compositions, errors)
        if not summaries:
            assert all(errors), case["label"]
            continue
        # what is assigned is what the text means
        assigned = tuple(t.TaskID for t in summaries[0].TaskList)
        term = algebra.parse(text, frozenset((1, 2, 3))) if text.strip() else None
        if term is not None:
            meant = {frozenset(algebra_meaning.tasks(b)) for b in algebra_meaning.branches(term)}
            assert frozenset(assigned) in meant, case["label"]
        else:
            assert set(assigned) == {1, 2, 3}
        assert len(set(assigned)) == len(assigned)
    assert not rig.said.has("fails at")


def test_more_ways_to_choose_than_are_looked_at_are_told(
    assigner: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(assign_problem, "BRANCHES_MAX", 2)
    made = [option(5, number, 1) for number in (1, 2, 3)]
    told = options(2, 5, *made, composition="+(.(p1 p2) .(p2 p3) .(p3 p1))")
    ways = [cost(1, 5, b, 1_000, (5, a)) for a in (1, 2, 3) for b in (1, 2, 3) if a != b]
    ways += [cost(1, 5, b, 1_000) for b in (1, 2, 3)]
    assigner.tell(unique(2, 5), told, matrix(2, *ways))
    assert len(assigner.got("TaskAssignmentSummary")) == 1
    assert (
        "of 3 ways to choose among alternatives the first 2 were" in assigner.reasons("Warning")[0]
    )


def test_large_option_ids_are_kept_apart(assigner: Rig) -> None:
    assigner.tell(
        unique(2, 5, 6),
        options(2, 5, option(5, 100_006, 1), option(5, 200_001, 1)),
        options(2, 6, option(6, 6, 1)),
        matrix(
            2,
            cost(1, 5, 100_006, 9_000),
            cost(1, 5, 200_001, 1_000),
            cost(1, 6, 6, 90_000),
            cost(1, 6, 6, 1_000, (5, 200_001)),
            cost(1, 6, 6, 2_000, (5, 100_006)),
        ),
    )
    (made,) = assigner.got("TaskAssignmentSummary")
    assert [(t.TaskID, t.OptionID) for t in made.TaskList] == [(5, 200_001), (6, 6)]


def test_a_matrix_before_the_options_is_named(assigner: Rig) -> None:
    assigner.tell(unique(2, 5, 6), options(2, 5, option(5, 1, 1)), matrix(2, cost(1, 5, 1, 4)))
    assert any("TaskPlanOptions of task 6" in text for text in assigner.reasons())
