"""Nothing holds by omission: every row that a requirement promises is there, seen or unknown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mission_tools import flown_text, vehicle_text

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.certify.verdicts import constraint_rows, requirement_rows, with_promised
from cratous.services.cli.job import plan_and_check
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.monitor import Monitor
from cratous.services.monitor import _whole as whole_verdict
from cratous.services.monitor.required_rows import PLAN_ROWS, promised, watched
from cratous.spec.mission import Change, Mission, changes
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.plan import Plan

TEXT = (
    flown_text("promised", *(vehicle_text(k, 2000 * (k - 1), 200 + 200 * k) for k in (1, 2, 3)))
    + """tasks:
  - {id: 1, kind: must_fly, eligible: [1], points: [{north_m: 500, east_m: 0, alt_m: 400}]}
  - {id: 2, kind: must_fly, eligible: [2], points: [{north_m: 900, east_m: 2000, alt_m: 600}]}
relations: ".(p1 p2)"
zones:
  - {id: 5, kind: keep_in, vertices: [[-3000, -3000], [-3000, 9000], [9000, 9000], [9000, -3000]]}
traffic:
  - {id: 90, position: {north_m: 5000, east_m: 5000, alt_m: 2000},
     velocity: {north_m_s: 30, east_m_s: 0}, appears_s: 7.3, vanishes_s: 21}
changes:
  - {at_s: 10, vehicle_joins: 3}
  - {at_s: 12.2, zone: {id: 6, kind: keep_out, vertices: [[7000, 7000], [7000, 7500], [7500, 7500]]}}
"""
)
Flown = tuple[Mission, Plan, list[Any]]


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> Flown:
    file = tmp_path_factory.mktemp("promised") / "mission.yaml"
    file.write_text(TEXT, encoding="utf-8")
    mission, bus = load(file), Bus(lmcp.full_names)
    messages: list[Any] = []
    plan, _ = plan_and_check(mission, bus)
    bus.tap(messages.append)
    assert fly(mission, plan, bus).outcome == "complete"
    return mission, plan, messages


def judged(
    flown: Flown, keep: Callable[[Any], bool] = lambda _: True, mission: Mission | None = None
) -> dict[tuple[str, str], Verdict]:
    """The verdicts on what is kept of the messages; all that is promised is among them."""
    monitor = Monitor(mission or flown[0], flown[1])
    for message in flown[2]:
        if keep(message):
            monitor.tap(message)
    rows = {(v.requirement, v.item): v for v in monitor.verdicts()}
    done, accepted = monitor.completion.done(), monitor.completion.accepted
    seen = watched(mission or flown[0], monitor._last_ms, done, accepted)
    there = {item for requirement, item in rows if requirement == "G1"}
    assert {(row.requirement, row.item) for row in promised(seen, there)} <= rows.keys()
    return rows


def is_of(message: Any, topic: str, vehicle: int = 0) -> bool:
    number = getattr(message.body, "VehicleID", 0)
    return message.topic.endswith(f".{topic}") and vehicle in (0, number)


def is_task(message: Any, task: int) -> bool:
    return is_of(message, "TaskProgress") and bool(message.body.TaskID == task)


def test_the_whole_flight_holds_in_every_promised_row(flown: Flown) -> None:
    rows = judged(flown)
    assert {v.outcome for v in rows.values()} == {Outcome.HOLDS}, [
        v for v in rows.values() if v.outcome is not Outcome.HOLDS
    ]
    # a vehicle that joins late is watched from the start, a zone from when it is known
    assert ("G1", "zone: keep_in 5, flight of vehicle 3") in rows
    late = rows["G1", "zone: keep_out 6, flight of vehicle 3"]
    assert 0 < late.checks < rows["G1", "zone: keep_in 5, flight of vehicle 3"].checks
    assert {item for r, item in rows if r == "G2" and item} == {
        f"well clear of {a} and {b}" for a, b in ((1, 2), (1, 3), (2, 3), (1, 90), (2, 90), (3, 90))
    }


def test_of_no_messages_nothing_holds(flown: Flown) -> None:
    rows = judged(flown, lambda _: False)
    assert {v.outcome for v in rows.values()} == {Outcome.UNKNOWN}
    assert {r for r, item in rows if item} == {"G1", "G2", "G3", "G4", "G5"}


LOST = [
    (lambda m: is_of(m, "TruthState", 2), {
        ("G1", "zone: keep_in 5, flight of vehicle 2"), ("G1", "zone: keep_out 6, flight of vehicle 2"),
        ("G2", "well clear of 1 and 2"), ("G2", "well clear of 2 and 90"), ("G2", "well clear of 2 and 3"), ("G3", "task 2 served"),
    }),
    (lambda m: is_of(m, "TruthState", 90), {
        ("G2", f"well clear of {own} and 90") for own in (1, 2, 3)
    }),
    (lambda m: is_of(m, "TruthState", 1) and m.body.Time == 15_000, {
        ("G1", "zone: keep_in 5, flight of vehicle 1"), ("G1", "zone: keep_out 6, flight of vehicle 1"),
        ("G2", "well clear of 1 and 2"), ("G2", "well clear of 1 and 3"), ("G2", "well clear of 1 and 90"),
    }),
    (lambda m: is_of(m, "TruthState") and m.body.Time > 25_000, {
        ("G1", f"zone: {zone}, flight of vehicle {v}")
        for zone in ("keep_in 5", "keep_out 6") for v in (1, 2, 3)
    } | {("G2", f"well clear of {a} and {b}") for a, b in ((1, 2), (1, 3), (2, 3))}
        | {("G3", "task 2 served")}),
    (lambda m: is_of(m, "MissionChange"), set()),
    (lambda m: is_of(m, "GatedCommand", 3), {("G4", "authority over vehicle 3")}),
]  # fmt: skip


@pytest.mark.parametrize("k", range(len(LOST)))
def test_what_is_not_seen_is_unknown_and_named(flown: Flown, k: int) -> None:
    lost, wanted = LOST[k]
    rows = judged(flown, lambda message: not lost(message))
    found = {key for key, v in rows.items() if key[1] and v.outcome is Outcome.UNKNOWN}
    assert found == wanted
    assert not [v for v in rows.values() if v.outcome is Outcome.VIOLATED]
    said = ("not observed", "no command was seen")
    assert all(any(text in rows[key].note for text in said) for key in found)


def test_heartbeats_that_are_not_seen_are_a_silence(flown: Flown) -> None:
    rows = judged(flown, lambda m: not is_of(m, "Heartbeat", 1))
    violated = {key for key, v in rows.items() if key[1] and v.outcome is Outcome.VIOLATED}
    ways = ("to", "from")
    assert violated == {("G5", f"heartbeat {way} the ICAROUS instance of 1") for way in ways}
    assert all("no heartbeat seen" in rows[key].note for key in violated)


def test_a_task_of_which_nothing_is_told_is_violated_and_its_rows_are_unknown(flown: Flown) -> None:
    rows = judged(flown, lambda m: not (is_task(m, 2)))
    assert rows["G3", "task 2 served"].outcome is Outcome.VIOLATED
    assert rows["G1", "eligibility: task 2 in flight"].outcome is Outcome.UNKNOWN
    assert [v.outcome for (_, item), v in rows.items() if "p2 starts" in item] == [Outcome.UNKNOWN]


@settings(max_examples=12, deadline=None)
@given(st.data())
def test_a_log_that_is_cut_makes_no_requirement_hold(flown: Flown, data: st.DataObject) -> None:
    count = data.draw(st.integers(0, len(flown[2]) - 1))
    end = next(k for k, m in enumerate(flown[2]) if is_of(m, "MissionEnd"))
    kept = {id(m) for m in flown[2][: min(count, end)]}
    rows = judged(flown, lambda message: id(message) in kept)
    assert {v.outcome for (_, item), v in rows.items() if not item} == {Outcome.UNKNOWN}


def test_a_planner_that_leaves_a_task_out_changes_no_row(flown: Flown) -> None:
    mission, plan, messages = flown
    for relations in ("", "|(p1 p2)"):
        other = replace(mission, relations=relations)
        monitor = Monitor(other, replace(plan, items=plan.items[:1], chosen=(1,)))
        for message in messages:
            if is_of(message, "PlanAccepted"):
                continue
            if not (is_task(message, 2)):
                monitor.tap(message)
        rows = {(v.requirement, v.item): v for v in monitor.verdicts()}
        assert rows["G3", "task 1 served"].outcome is Outcome.HOLDS
        assert rows["G3", "task 2 served"].outcome is Outcome.VIOLATED
        assert rows["G3", ""].outcome is Outcome.VIOLATED


def test_of_a_choice_one_branch_is_judged(flown: Flown) -> None:
    mission = replace(flown[0], relations="+(p1 p2)")

    def without(task: int) -> dict[tuple[str, str], Verdict]:
        return judged(flown, lambda m: not (is_task(m, task)), mission)

    assert {v.outcome for v in without(1).values()} == {Outcome.HOLDS}
    assert ("G3", "task 1 served") not in without(1)
    both = judged(flown, mission=mission)
    beside = both["G1", "flight: no task of another choice of the relations"]
    assert beside.outcome is Outcome.VIOLATED
    assert "tasks 2 were begun besides" in beside.note


def test_a_task_that_is_withdrawn_while_it_is_flown_is_asked_of_nobody(flown: Flown) -> None:
    mission, _, messages = flown
    begun = next(
        m.body.Time for m in messages
        if is_task(m, 2) and m.body.Phase.name == "Active"
    )  # fmt: skip
    gone = Change(begun + 1, changes.TASK_REMOVED, task=2)
    other = replace(mission, changes=(*mission.changes, gone))
    ended = judged(
        flown,
        lambda m: not (is_task(m, 2) and m.body.Time > begun),
        other,
    )
    assert ("G3", "task 2 served") not in ended
    assert ended["G3", ""].outcome is Outcome.HOLDS
    assert ended["G1", "eligibility: task 2 in flight"].outcome is Outcome.HOLDS


def test_the_first_of_two_who_flew_a_task_is_judged_too(flown: Flown) -> None:
    monitor = Monitor(flown[0], flown[1])
    for message in flown[2]:
        if is_task(message, 2) and message.body.Phase.name == "Active":
            monitor.tap(replace(message, body=message.body.copy(VehicleID=1)))
        monitor.tap(message)
    rows = {(v.requirement, v.item): v for v in monitor.verdicts()}
    flown_by = rows["G1", "eligibility: task 2 in flight"]
    assert (flown_by.outcome, flown_by.vehicles) == (Outcome.VIOLATED, (1, 2))


def test_a_report_has_every_promised_row(flown: Flown) -> None:
    mission, plan, _ = flown
    seen = watched(mission, 40_000, {1, 2}, set(plan.chosen))
    rows = constraint_rows(judged(flown).values(), "flight")
    kept = [row for row in rows if row["item"] != "task 2 served"]
    found = with_promised(kept, seen)
    added = {(row["source"], row["item"]): row for row in found[len(kept) :]}
    assert added.keys() == {("flight", "task 2 served"), *(("plan", row.item) for row in PLAN_ROWS)}
    assert {row["verdict"] for row in added.values()} == {"unknown"}
    assert {row["note"] for row in added.values()} == {"not observed"}
    whole = {row["requirement"]: row["verdict"] for row in requirement_rows(found)}
    assert (whole["G1"], whole["G3"]) == ("unknown", "unknown")


def test_that_nobody_was_met_is_said_only_of_who_was_seen(tmp_path: Path) -> None:
    file = tmp_path / "mission.yaml"
    text = TEXT[: TEXT.index("traffic:")].replace("[2]", "[1]")
    start, stop = text.index("  - {id: 2, position"), text.index("tasks:")
    file.write_text(text[:start] + text[stop:], encoding="utf-8")
    mission, bus = load(file), Bus(lmcp.full_names)
    plan, _ = plan_and_check(mission, bus)
    messages: list[Any] = []
    bus.tap(messages.append)
    fly(mission, plan, bus)
    alone = ("G2", "well clear of 1")
    assert judged((mission, plan, messages))[alone].outcome is Outcome.HOLDS
    gone = judged((mission, plan, messages), lambda m: not is_of(m, "TruthState"))
    assert gone[alone].outcome is Outcome.UNKNOWN


def test_what_was_not_served_is_told_by_its_task() -> None:
    items = ("end of mission", "task 5 served")
    parts = [Verdict("G3", item, Outcome.VIOLATED, Kind.OBSERVED, "n") for item in items]
    assert requirement_rows(constraint_rows(parts, "flight"))[2]["item"] == "task 5 served"
    assert whole_verdict("G3", parts).note == "task 5 served: n"
