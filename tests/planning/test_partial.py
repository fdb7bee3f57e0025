"""The part of a mission that leaves out least: against trying everything, and through the services."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain, combinations
from pathlib import Path
from random import Random

import pytest
from planning_tools import FOUR, TWO, mission

from cratous.bridge import lmcp
from cratous.core import ledger
from cratous.services.bus import Bus
from cratous.services.cli import main
from cratous.services.cli.plan import why_lines
from cratous.services.monitor.plan_check import PART, WHOLE, check_plan
from cratous.services.pipeline.plan import make_plan
from cratous.services.planning import reasons
from cratous.services.planning.assign import Limits, search
from cratous.services.planning.assign_problem import parts
from cratous.services.planning.partial import Parts, part_problem, restricted
from cratous.services.planning.vehicle_alternatives import why
from cratous.spec.algebra.meaning import tasks
from cratous.spec.algebra.partial import may_be_done, only
from cratous.spec.assignment.search import AssignmentProblem, Choice, Solution
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.mission.guarantees import Outcome
from cratous.spec.mission.plan import PartialPlan, Pose, left_out_of

RELATIONS = (
    "|(p1_[0-30] p2_[0-30] p3_[0-30] p4)",
    "|(.(p1 p2) .(p3 p4)_[0-25])",
    "+(.(p1 p2_[0-12]) |(p3 p4_[0-9]))",
    ".(p1 +(p2_[0-20] .(p3 p4)_[0-40]))",
    "~(p1_[5-22] p2 |(p3 p4))-[0-30]",
    ".(|(p1 p2) p3_[0-33] p4)",
)


def random_problem(random: Random, relations: str) -> AssignmentProblem:
    """Four tasks for two vehicles; every task to every vehicle or to one, or to none."""
    who = [(1, 2), (1,), (2,), ()]
    choices = tuple(
        Choice(t, 1, random.randrange(2, 9), random.choice(who[: 4 if t == 2 else 3]))
        for t in (1, 2, 3, 4)
    )
    travel = tuple(
        tuple(
            tuple(random.randrange(1, 15) if v in c.vehicles else None for c in choices)
            for _ in range(5)
        )
        for v in (1, 2)
    )
    return AssignmentProblem("random", (1, 2), (0, 0), choices, travel, relations)


def least_left_out(problem: AssignmentProblem, ranking: Parts) -> tuple[tuple[int, ...], int]:
    """By trying every set of tasks of every branch."""
    found = []
    for k, branch in enumerate(ranking.branches):
        names = tasks(branch)
        sets = chain(*(combinations(names, n) for n in range(1, len(names) + 1)))
        for kept in map(frozenset, sets):
            if not (may_be_done(branch, kept) and kept <= ranking.able):
                continue
            term = only(branch, kept)
            assert term is not None
            asked = restricted(problem, [term])
            if search(asked, Limits(nodes=20_000), *parts(asked)).cost is not None:
                found.append(ranking.rank((k, kept)))
    return min(found)


@pytest.mark.parametrize("relations", RELATIONS)
@pytest.mark.parametrize("seed", range(4))
def test_the_part_leaves_out_least_of_all(relations: str, seed: int) -> None:
    random = Random(seed)
    problem = random_problem(random, relations)
    priority = {t: random.randrange(0, 3) for t in (1, 2, 3, 4)}
    all_of = Parts(problem, priority)
    chosen = all_of.choose()
    assert chosen.sure
    if not chosen.parts:
        with pytest.raises(ValueError, match="empty"):
            least_left_out(problem, all_of)
        return
    assert {all_of.rank(part) for part in chosen.parts} == {least_left_out(problem, all_of)}
    for part in chosen.parts:
        assert may_be_done(all_of.branches[part[0]], part[1])


def test_with_few_questions_the_higher_priorities_go_first(monkeypatch: pytest.MonkeyPatch) -> None:
    from cratous.services.planning import partial

    problem = random_problem(Random(2), "|(p1_[0-9] p2_[0-9] p3_[0-9] p4_[0-9])")
    monkeypatch.setattr(partial, "ASKED_MAX", 0)
    all_of = Parts(problem, {1: 0, 2: 0, 3: 5, 4: 0})
    chosen = all_of.choose()
    assert not chosen.sure
    alone = Parts(problem, {})
    assert len(chosen.parts) == 1
    assert (3 in chosen.parts[0][1]) == bool(alone.ask((0, frozenset({3}))))


def test_a_part_that_others_chose_has_a_problem_of_its_own() -> None:
    problem = random_problem(Random(0), ".(p1 +(p2 .(p3 p4)))")
    assert part_problem(problem, {1, 3, 4}) is problem
    assert part_problem(problem, {1, 3}).tasks == (1, 3)
    assert part_problem(problem, {3}) is problem, "3 must wait for 1: this is no part"


def test_the_plan_of_a_part_is_checked_and_its_answer_names_what_is_left_out() -> None:
    of = mission(relations="|(.(p1_[0-9] p2) p3 p4)")
    bus, said = Bus(lmcp.full_names), []
    bus.tap(lambda e: said.append(e.body) if e.topic.endswith(".AutomationResponse") else None)
    plan = make_plan(of, bus)
    assert isinstance(plan, PartialPlan)
    assert plan.sure
    assert sorted(item.task_id for item in plan.items) == [3, 4]
    one, two = left_out_of(plan)
    assert (one.task_id, one.waiting) == (1, (2,))
    assert two.reason == (
        "it must wait for what is not done: `.(p1_[0-9] p2)`: p2 starts no earlier than p1 ends"
    )
    told = [pair.Value for pair in said[-1].Info]
    assert [text.split(" (")[0] for text in told] == ["left out: task 1", "left out: task 2"]
    checks = {check.item: check for check in check_plan(of, plan)}
    assert checks[WHOLE].outcome is Outcome.VIOLATED
    assert checks[WHOLE].note.endswith("left out: 1, 2")
    assert checks[PART].outcome is Outcome.HOLDS
    # a plan that does a task whose predecessor it leaves out is no part
    wrong = mission(FOUR, TWO, relations=".(p1 p2 p3 p4)")
    found = {check.item: check.outcome for check in check_plan(wrong, plan)}
    assert PART not in found
    assert found[WHOLE] is Outcome.VIOLATED


def test_undone_tasks_stay_undone_and_begun_ones_make_the_choice() -> None:
    of = mission(relations="|(.(p1 p2) +(p3 p4))")
    plan = make_plan(of, undone={1: "its window was missed"})
    assert sorted(item.task_id for item in plan.items) in ([3], [4])
    assert [left.task_id for left in left_out_of(plan)] == [1, 2]
    assert left_out_of(plan)[0].reason == "it ended undone: its window was missed"
    plan = make_plan(of, undone={4: "why"}, begun=[4])
    assert {left.task_id for left in left_out_of(plan)} == {4}, "p3 is of another choice"
    with pytest.raises(NoPlan):
        make_plan(mission(FOUR[:1], relations="p1_[0-9]"))


def test_of_a_choice_of_which_nothing_is_done_each_task_has_a_reason() -> None:
    plan = make_plan(mission(relations="|(+(p1_[0-9] .(p2_[0-9] p4)) p3)"))
    assert [item.task_id for item in plan.items] == [3]
    found = {left.task_id: left for left in left_out_of(plan)}
    assert found.keys() == {1, 2, 4}
    assert found[1].reason.startswith("task 1 must end by 0.009 s")
    assert found[2].reason.startswith("task 2 must end by 0.009 s")
    assert found[4].reason.startswith("it must wait for what is not done")


def test_the_whole_gets_no_reasons_where_a_part_can_be_done(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They would be thrown away, and cost most of the time of planning."""
    asked: list[tuple[int, ...]] = []
    found = reasons.timing_reasons

    def told(problem: AssignmentProblem, solution: Solution) -> tuple[str, ...]:
        asked.append(problem.tasks)
        return found(problem, solution)

    monkeypatch.setattr(reasons, "timing_reasons", told)
    plan = make_plan(mission(relations="|(p1_[0-9] p2 p3 p4)"))
    assert [left.task_id for left in left_out_of(plan)] == [1]
    assert asked == [(1,)]


def test_a_choice_that_could_be_made_but_leaves_out_more_says_so() -> None:
    """Task 4 has no schedule and goes before task 1; of `|(p2 p4)` p2 could be done."""
    tasks_of = (*(replace(task, priority=1) for task in FOUR[:1]), *FOUR[1:3])
    more = replace(FOUR[3], priority=2)
    of = mission((*tasks_of, more), relations="|(+(p1_[0-9] |(p2 p4_[0-9])) p3)")
    plan = make_plan(of)
    assert [item.task_id for item in plan.items] == [3]
    found = {left.task_id: left.reason for left in left_out_of(plan)}
    assert found.keys() == {1, 2, 4}
    assert found[2] == "it could be done, but another choice of the relations leaves out less"


def test_what_was_flown_stays_done_whatever_became_of_what_it_followed() -> None:
    """Of `~(p2 p1)` p2 was begun and given up, p1 flown; the window of p3 cannot be kept: nothing is left, no error."""
    of = mission(FOUR[:3], relations="|(~(p2 p1) p3_[0-9])")
    starts = {v.id: Pose(*v.position, v.heading_rad) for v in of.vehicles}
    with pytest.raises(NoPlan, match="given up"):
        make_plan(of, starts=starts, done=[(1, 0, 5000)], now_ms=6000, undone={2: "given up"})
    of = mission(FOUR, relations="|(~(p2 p1) p3_[0-9] p4)")
    plan = make_plan(of, starts=starts, done=[(1, 0, 5000)], now_ms=6000, undone={2: "given up"})
    assert [item.task_id for item in plan.items] == [4]
    assert [left.task_id for left in left_out_of(plan)] == [2, 3]


def test_why_this_vehicle_is_told_for_each_other_one() -> None:
    plan_of = mission((FOUR[0], replace(FOUR[1], eligible=(2,))), relations="|(p1 p2_[0-900000])")
    plan = make_plan(plan_of)
    who = {item.task_id: item.vehicle_id for item in plan.items}
    assert who == {1: 1, 2: 2}
    own, other = why(plan_of, plan, 1, {})
    assert (own.vehicle, own.cost, own.reason) == (1, plan.makespan_ms, "")
    # with the other vehicle the whole plan costs what a plan with that vehicle alone does
    alone = make_plan(replace(plan_of, tasks=(replace(FOUR[0], eligible=(2,)), plan_of.tasks[1])))
    assert (other.vehicle, other.cost, other.reason) == (2, alone.makespan_ms, "")
    assert why_lines(plan_of, plan, 1, (own, other)) == [
        f"task 1 is given to vehicle 1: the plan costs {plan.makespan_ms / 1000:.1f} s",
        f"  with vehicle 2: the best plan would cost {alone.makespan_ms / 1000:.1f} s"
        + ("" if other.sure else ", or less"),
    ]
    refused = why(plan_of, plan, 2, {3: "it was lost at 0.00 s"})
    assert [one.reason for one in refused] == [
        "the task does not name it eligible", "", "it was lost at 0.00 s"
    ]  # fmt: skip
    with pytest.raises(BadInput, match="no such task in the plan"):
        why(plan_of, plan, 9, {})


def test_why_of_no_task_is_refused_before_anything_that_takes_time(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(ledger, "require", None)
    crossing = Path(__file__).parents[2] / "examples" / "crossing" / "mission.yaml"
    assert main(["plan", str(crossing), "--why", "9"]) == 2
    assert "no such task in the mission; expected one of 1, 2; got 9" in capsys.readouterr().err
