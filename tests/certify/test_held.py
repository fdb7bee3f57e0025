"""A report beside judgements that no flight of ours gives: each answer has its consequence."""

from __future__ import annotations

from typing import Any

import pytest

from cratous.judge import Judgement
from cratous.judge.answers import Answer
from cratous.judge.verdict import Row
from cratous.services.attestation.verdicts_check import held

ITEM = {
    "G1": "eligibility: task 1 in flight", "G2": "well clear of 1 and 2", "G3": "task 1 served",
    "G4": "authority over vehicle 1", "G5": "heartbeat to the ICAROUS instance of 1",
}  # fmt: skip


def report(verdict: str = "holds") -> dict[str, Any]:
    rows = [
        {
            "requirement": name,
            "source": "flight",
            "item": item,
            "verdict": verdict,
            "vehicles": [1, 2],
        }
        for name, item in ITEM.items()
    ]
    return {
        "verdict": verdict, "constraints": rows, "not_covered": [],
        "requirements": [{"requirement": name, "verdict": verdict} for name in ITEM],
        "mission": {"vehicles": [{"id": 1, "protected": True}]},
    }  # fmt: skip


def judgement(verdicts: dict[str, str], answers: tuple[Answer, ...] = ()) -> Judgement:
    rows = tuple(
        Row(name, (name,), item, verdicts.get(name, "holds"), "", None, 1)
        for name, item in ITEM.items()
    )
    return Judgement(rows, (), True, (), "", answers)


def answer(name: str, monitor: str, judge: str) -> Answer:
    return Answer(name, ITEM[name], monitor, judge)


def test_all_hold_only_if_both_say_so() -> None:
    same = tuple(answer(name, "holds", "holds") for name in ITEM)
    found = held(report(), judgement({}, same))
    assert (found.refused, found.undecided, found.verdict) == ([], [], "holds")
    assert (found.expected, found.confirmed) == (5, 5)
    found = held(report(), judgement({"G3": "unknown"}, same))
    assert (found.undecided, found.verdict) == (["G3: the judge says unknown"], "unknown")
    # a requirement that the report does not list is one that the judge has all the same
    short = {**report(), "requirements": report()["requirements"][:2]}
    assert held(short, judgement({"G3": "unknown"}, same)).verdict == "unknown"
    # said once, by its row
    other = (*same[:2], answer("G3", "holds", "unknown"), *same[3:])
    found = held(report(), judgement({"G3": "unknown"}, other))
    line = "G3 task 1 served: holds, the judge says unknown"
    assert (found.undecided, found.confirmed, found.verdict) == ([line], 4, "unknown")


def test_a_report_that_does_not_hold_is_none_that_does() -> None:
    for verdict, shown in (
        ("unknown", "unknown"),
        ("excused", "unknown"),
        ("violated", "violated"),
    ):
        assert held(report(verdict), judgement({})).verdict == shown


def test_a_row_that_the_judge_lacks_is_not_among_those_it_expects() -> None:
    lacking = answer("G3", "", "holds"), answer("G4", "", "holds")
    found = held(report(), judgement({}, (answer("G1", "unknown", ""), *lacking)))
    assert (found.expected, found.confirmed, found.refused, len(found.undecided)) == (2, 0, [], 3)
    assert found.verdict == "unknown"


@pytest.mark.parametrize(("monitor", "judge"), [("holds", "violated"), ("violated", "holds")])
def test_a_contradiction_is_refused_without_the_summary_of_the_judge_as_well(
    monitor: str, judge: str
) -> None:
    found = held(report(), judgement({}, (answer("G1", monitor, judge),)))
    assert found.refused == [f"G1 {ITEM['G1']}: {monitor}, the judge says {judge}"]


@pytest.mark.parametrize("name", ["G1", "G3", "G4", "G5"])
@pytest.mark.parametrize("judge", ["violated", "unknown"])
def test_only_a_loss_of_well_clear_can_be_excused(name: str, judge: str) -> None:
    found = held(report("excused"), judgement({}, (answer(name, "excused", judge),)))
    assert len(found.refused) == 1
    assert "only a loss of well clear can be excused" in found.refused[0]


def test_an_excuse_of_what_the_judge_did_not_see_lost() -> None:
    """Without the instant of the loss there is nothing that evidence could be about."""
    found = held(report("excused"), judgement({}, (answer("G2", "excused", "violated"),)))
    assert "the report has no evidence on the loss at None ms" in found.refused[0]


def test_the_answers_of_a_judge_that_does_not_cover_a_vehicle() -> None:
    told = {**report(), "not_covered": [3, 2]}
    assert not held(told, Judgement((), (), True, (2, 3), "")).refused
    assert held(told, judgement({})).refused == [
        "report.json: not covered are [3, 2], by the log []"
    ]
