"""The judge's answers to the rows of a report: all that it expects, in the words of the report."""

from __future__ import annotations

from pathlib import Path

import judge_tools as tools
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from judge_tools import Scene, full, row, task

from cratous.judge import judge
from cratous.judge.algebra import parse
from cratous.judge.answers import ANOTHER_CHOICE, SENTENCE
from cratous.judge.relations import _Way, ways
from cratous.services.monitor.required_rows import CHOICE
from cratous.spec import algebra
from cratous.spec.algebra.meaning import branches
from cratous.spec.algebra.meaning import rows as spec_rows


def test_every_row_of_a_report_on_the_flight_is_answered(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    rows[0]["verdict"] = "unknown"
    rows.append(row("G1", ANOTHER_CHOICE, "holds"))
    rows.append(row("G1", "flight: `p1_[0-9]`: judged together", "violated"))
    rows.append(row("G2", "a row that nobody knows", "holds"))
    rows.append(row("G1", "plan: something", "violated") | {"source": "plan"})
    found = judge(tools.with_report(log, rows)).answers
    assert sorted(one.item for one in found) == sorted(r["item"] for r in rows[:-1])
    open_ = {one.item: one.judge for one in found if not one.confirmed}
    assert open_ == {rows[0]["item"]: "holds", rows[-3]["item"]: "", rows[-2]["item"]: ""}
    assert {one.item for one in found if one.foreign} == {r["item"] for r in rows[-3:-1]}
    assert judge(log.with_name("log.sqlite")).answers == found
    assert judge(Path(log.rename(tmp_path / "alone.sqlite"))).answers == ()


def test_a_row_that_is_lacking_is_answered_as_well(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    found = judge(tools.with_report(log, rows[1:])).answers
    lacking = [(one.item, one.judge) for one in found if not one.monitor]
    assert lacking == [(ANOTHER_CHOICE, "holds"), (rows[0]["item"], "holds")]
    assert not any(one.confirmed for one in found if not one.monitor)
    assert {one.item for one in found if one.monitor} == {r["item"] for r in rows[1:]}


def test_a_second_row_on_the_same_is_not_confirmed(tmp_path: Path) -> None:
    log, rows = full(tmp_path)
    rows.append(row("G2", "well clear of 2 and 1", "holds"))
    rows.append(dict(rows[0]))
    found = judge(tools.with_report(log, rows)).answers
    confirmed = [one.item for one in found if one.confirmed]
    assert confirmed.count(rows[0]["item"]) == 1
    assert "well clear of 1 and 2" in confirmed
    assert "well clear of 2 and 1" not in confirmed


def test_a_vehicle_that_met_nobody_is_one_of_the_mission(tmp_path: Path) -> None:
    """A row of the monitor on a vehicle alone, which the judge has pair by pair or not at all."""
    log, rows = full(tmp_path)
    rows += [row("G2", f"well clear of {number}", "holds") for number in (1, 99)]
    found = judge(tools.with_report(log, rows))
    answers = {one.item: one.judge for one in found.answers}
    assert (answers["well clear of 1"], answers["well clear of 99"]) == ("holds", "")
    assert [one.item for one in found.disagreements] == ["well clear of 99"]


# ---- the relations, sentence by sentence ---------------------------------------------------------


def test_the_row_on_another_choice_is_that_of_the_monitor() -> None:
    assert ANOTHER_CHOICE == CHOICE


@st.composite
def relations(draw: st.DrawFn) -> str:
    """Each task once; windows of both kinds anywhere, long texts and long groups too."""
    left = list(range(1, draw(st.integers(1, 11)) + 1))

    def term(names: list[int], depth: int) -> str:
        if len(names) == 1 and (depth == 0 or draw(st.booleans())):
            text = f"p{names[0]}"
        else:
            cuts = sorted(draw(st.sets(st.integers(1, len(names) - 1), max_size=3))) if len(names) > 1 else []  # fmt: skip
            parts = [names[a:b] for a, b in zip([0, *cuts], [*cuts, len(names)], strict=True)]
            if len(parts) == 1 and depth == 0:
                parts = [[name] for name in names]
            inner = " ".join(term(part, max(depth - 1, 0)) for part in parts)
            text = f"{draw(st.sampled_from('.~|+'))}({inner})"
        window = draw(st.sampled_from(["", "", "_[0-9]", "-[10-2000]", "_[5-123456]"]))
        return text + window

    return term(left, 3)


@settings(max_examples=150, deadline=None)
@given(relations())
def test_its_sentences_are_those_of_the_definition(text: str) -> None:
    """Each way of the judge says what a branch of `spec.algebra` says, word for word."""
    theirs = {frozenset(r.text for r in spec_rows(one)) for one in branches(algebra.parse(text))}
    mine = set()
    for one, _ in ways(parse(text), set()):
        way = _Way({})
        way.look(one, None)
        mine.add(frozenset(part for found in way.found for part, _ in found.parts))
    assert mine == theirs
    assert all(SENTENCE.fullmatch(f"flight: {part}") for said in theirs for part in said)


ORDERED = "flight: `.(p1 p2)_[0-6000]`: "
SAID = {
    f"{ORDERED}p2 starts no earlier than p1 ends": "holds",
    f"{ORDERED}p1 starts at 0 ms or later": "holds",
    f"{ORDERED}p1 ends at 6000 ms or earlier": "holds",
    f"{ORDERED}p2 starts at 0 ms or later": "holds",
    f"{ORDERED}p2 ends at 6000 ms or earlier": "violated",
    ANOTHER_CHOICE: "violated",  # without a `+` it is as good as all relations
}


def ordered(folder: Path, relations: str = ".(p1 p2)_[0-6000]", **more: int) -> Path:
    points = [task(n, "must_fly", (100, 0)) for n in (1, 2, *([3] if "p3" in relations else []))]
    scene = Scene(tasks=points, relations=relations).straight(1, (0, 0, 300), (20.0, 0.0, 0.0))
    scene.does(1, 1, 1000, 2000).does(2, 1, 3000, more.get("end_ms", 7000))
    return scene.write(folder / "log.sqlite")


def answers(log: Path, said: dict[str, str]) -> dict[str, tuple[str, str, bool]]:
    """Those on the relations: (monitor, judge, foreign) by item."""
    found = judge(tools.with_report(log, [row("G1", k, v) for k, v in said.items()])).answers
    return {a.item: (a.monitor, a.judge, a.foreign) for a in found if a.item.startswith("flight")}


def test_each_relation_is_answered_by_itself(tmp_path: Path) -> None:
    found = answers(ordered(tmp_path), SAID)
    assert found == {item: (verdict, verdict, False) for item, verdict in SAID.items()}


@pytest.mark.parametrize("gone", SAID)
def test_a_relation_that_is_left_out_is_missed(tmp_path: Path, gone: str) -> None:
    found = answers(ordered(tmp_path), {k: v for k, v in SAID.items() if k != gone})
    assert found[gone] == ("", SAID[gone], False)


def test_a_relation_that_the_mission_does_not_state_is_foreign(tmp_path: Path) -> None:
    turned = f"{ORDERED}p1 starts no earlier than p2 ends"
    assert SENTENCE.fullmatch(turned)
    assert answers(ordered(tmp_path), {**SAID, turned: "holds"})[turned] == ("holds", "", True)
    # where there is a choice to make the monitor may have made another one: open, and not confirmed
    log = ordered(tmp_path / "choice", "+(.(p1 p2) p3)")
    other = "flight: `p3_[0-9]`: p3 ends at 9 ms or earlier"
    found = answers(log, {other: "holds", "flight: it was a fine day": "holds"})
    assert found[other] == ("holds", "", False)
    assert found["flight: it was a fine day"] == ("holds", "", True)
    assert found[ANOTHER_CHOICE] == ("", "holds", False)


def test_what_is_in_doubt_as_a_whole_is_so_in_its_sentences(tmp_path: Path) -> None:
    """A log that stops before the mission ends: what seemed to hold is unknown."""
    points = [task(n, "must_fly", (100, 0)) for n in (1, 2)]
    scene = Scene(tasks=points, relations=".(p1 p2)").straight(1, (0, 0, 300), (20.0, 0.0, 0.0))
    scene.does(1, 1, 1000, 2000).does(2, 1, 3000, 7000)
    item = "flight: `.(p1 p2)`: p2 starts no earlier than p1 ends"
    found = answers(scene.write(tmp_path / "log.sqlite", end=""), {item: "holds"})
    assert found[item] == ("holds", "unknown", False)


def test_a_mission_without_any_task_left_has_the_row_on_the_choice(tmp_path: Path) -> None:
    removed = [tools.changed(1000, "task_removed", 1)]
    scene = Scene(tasks=[task(1, "must_fly", (900, 0))], changes=removed)
    log = scene.straight(1, (0, 0, 300), (20.0, 0.0, 0.0)).write(tmp_path / "log.sqlite")
    found = judge(tools.with_report(log, [row("G1", ANOTHER_CHOICE, "holds")]))
    assert not found.disagreements
    (answer,) = [one for one in found.answers if one.item == ANOTHER_CHOICE]
    assert answer.confirmed


def test_what_was_not_to_be_decided_need_not_be_said(tmp_path: Path) -> None:
    """Nobody began the task of the other choice: the monitor has no row on who may do it."""
    found = judge(tools.with_report(ordered(tmp_path, "+(.(p1 p2) p3)"), []))
    items = {one.item for one in found.answers}
    assert "eligibility: task 2 in flight" in items
    assert "eligibility: task 3 in flight" not in items
    assert "well clear of 1" in items
