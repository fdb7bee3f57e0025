"""The watch of what a served mission needs: stays, time and failures, told message by message."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from flight_tools import meeting

from cratous.bridge import lmcp
from cratous.services.assumptions.observations import Message, Observed
from cratous.services.assumptions.service_assumptions import ServedWatch
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS, MOST_TAKEOVERS
from cratous.spec.mission import Change, Mission
from cratous.spec.mission.changes import TASK_REMOVED, VEHICLE_HOLDS

MISSION = meeting()
END_MS = 3_000_000
LONGEST_MS = round(1000 * LONGEST_LOOKAHEADS * MISSION.daa.lookahead_s)
LATE_MS = 4 * MISSION.simulation.heartbeat_ms
Told = tuple[int, str, dict[str, Any]]


def task(at_ms: int, phase: str = "Transit", task_id: int = 1, note: str = "", **more: Any) -> Told:
    return at_ms, "TaskProgress", {"TaskID": task_id, "Phase": phase, "Note": note, **more}


def gate(at_ms: int, owner: str, offered: bool = False, epoch: int = 1) -> Told:
    return at_ms, "GateState", {"Owner": owner, "Offered": offered, "Epoch": epoch}


def taken(at_ms: int, for_ms: int) -> list[Told]:
    return [gate(at_ms, "ICAROUS"), gate(at_ms + for_ms, "ICAROUS", True)]


def observed(name: str, *told: Told, mission: Mission = MISSION) -> Observed:
    watch = ServedWatch(mission)
    for at_ms, kind, fields in sorted(told, key=lambda one: one[0]):
        whose = {} if kind == "PlanAccepted" else {"VehicleID": 1}
        if kind != "GatedCommand":
            whose["Time"] = at_ms
        body = lmcp.new(f"cratous.{kind}", **{**whose, **fields})
        watch.message(Message(kind, at_ms, "", body))
    watch.end(END_MS)
    return watch.records()[name].observed(END_MS, True)


@pytest.mark.parametrize(("over_ms", "state"), [(0, "held"), (1, "broken")])
def test_a_stay_may_last_as_long_as_one_more_like_it_is_allowed(over_ms: int, state: str) -> None:
    half_ms = LONGEST_MS // 2 - LATE_MS + over_ms
    found = observed("stays bounded", task(0), *taken(1000, half_ms), task(END_MS, "Complete"))
    assert found.state == state
    assert (found.broken and found.broken.since_ms) == (1000 + half_ms if over_ms else None)


@pytest.mark.parametrize(("times", "state"), [(MOST_TAKEOVERS, "held"), (MOST_TAKEOVERS + 1, "broken")])  # fmt: skip
def test_so_many_short_stays_are_allowed_on_an_item(times: int, state: str) -> None:
    often = [told for k in range(times) for told in taken(10_000 * (k + 1), 1000)]
    assert observed("stays bounded", task(0), *often, task(END_MS, "Complete")).state == state
    # on two items neither is too much
    half = [*often, task(10_000 * (times // 2) + 5000, "Complete"), task(10_000 * (times // 2) + 5001, task_id=2)]  # fmt: skip
    assert observed("stays bounded", task(0), *half).state == "held"


def test_a_withdrawn_offer_is_counted_as_uxas_counts_it() -> None:
    often = [told for k in range(MOST_TAKEOVERS + 1) for told in taken(10_000 * (k + 1), 1000)]
    found = observed("stays bounded", task(0), *often)
    assert found.note.startswith(f"vehicle 1 was taken over {MOST_TAKEOVERS + 1} times")


def test_a_stay_that_is_open_at_the_end_counts_up_to_it() -> None:
    assert observed("stays bounded", task(0), gate(1000, "ICAROUS")).state == "broken"


def test_who_holds_by_command_or_flies_without_its_link_is_not_held_to_its_time() -> None:
    long = [task(0), *taken(1000, LONGEST_MS)]
    holds = replace(MISSION, changes=(Change(5000, VEHICLE_HOLDS, vehicle=1),))
    assert observed("stays bounded", *long, mission=holds).state == "not observed"
    unheard = (500, "LinkLossState", {"Mode": "Return"})
    assert observed("stays bounded", *long, unheard).state == "not observed"
    assert observed("stays bounded", task(0)).state == "not observed"


@pytest.mark.parametrize(("left_ms", "state"), [(20_000, "held"), (0, "broken")])
def test_the_longest_stay_on_each_item_fits_before_the_limit(left_ms: int, state: str) -> None:
    simulation = replace(MISSION.simulation, limit_ms=200_000)
    mission = replace(MISSION, simulation=simulation)
    # 10 s each time, once and once more, on two items
    done_ms = 200_000 - 4 * (10_000 + LATE_MS) + 10_000 - left_ms + 1
    told = [task(0), *taken(1000, 10_000), task(50_000, "Complete"), task(50_001, task_id=2)]
    found = observed("flown in time", *told, task(done_ms, "Complete", 2), mission=mission)
    assert found.state == state


@pytest.mark.parametrize(
    ("note", "state"),
    [("blocked: ICAROUS took vehicle 1 over", "held"), ("no way keeps the zones", "broken")],
)
def test_a_task_fails_for_what_icarous_flew_or_for_another_reason(note: str, state: str) -> None:
    found = observed("no other failure", task(0), task(9000, "Failed", note=note))
    assert found.state == state
    if found.broken:
        assert found.broken == (9000, 1, f"task 1 failed: {note}")


def test_takeovers_and_stays_are_bounded_alike_on_all_items_of_a_chain() -> None:
    """Each item alone is within what is allowed; the theorem takes one bound for all of them."""
    often = [told for k in range(MOST_TAKEOVERS - 1) for told in taken(10_000 * (k + 1), 1000)]
    long_ms = LONGEST_MS // 4 - LATE_MS
    first = [task(0), *often, task(150_000, "Complete")]
    second = [task(150_001, task_id=2), *taken(160_000, long_ms), task(END_MS, "Complete", 2)]
    assert observed("stays bounded", *first).state == "held"
    assert observed("stays bounded", *second).state == "held"
    found = observed("stays bounded", *first, *second)
    assert found.state == "broken"
    assert found.note.startswith(f"vehicle 1 was taken over {MOST_TAKEOVERS - 1} times on its way to an earlier task")  # fmt: skip


def test_a_stay_under_which_an_item_begins_counts_on_it() -> None:
    told = [task(0), gate(1000, "ICAROUS"), task(2000, "Complete"), task(2001, task_id=2)]
    done = task(END_MS, "Complete", 2)
    brief = observed("stays bounded", *told, gate(3000, "ICAROUS", True), done)
    long = observed("stays bounded", *told, gate(2001 + LONGEST_MS, "ICAROUS", True), done)
    assert (brief.state, long.state) == ("held", "broken")


@pytest.mark.parametrize(
    "left", [task(65_000, "Waiting", VehicleID=0), task(65_000, task_id=2)], ids=["waits", "other"]
)
def test_takeovers_count_on_the_item_to_which_the_vehicle_flies(left: Told) -> None:
    often = [told for k in range(MOST_TAKEOVERS + 1) for told in taken(10_000 * (k + 1), 1000)]
    found = observed("stays bounded", task(0), *often, left, task(65_001, task_id=2))
    assert found.state == "held"


COMMAND = (5000, "GatedCommand", {"Sender": "ICAROUS", "Epoch": 1})
CHANGE = (5000, "AuthorityChange", {"Owner": "ICAROUS", "Epoch": 1})


@pytest.mark.parametrize("told", [COMMAND, CHANGE, gate(5000, "UxAS", epoch=2)], ids=lambda t: t[1])  # fmt: skip
def test_a_takeover_of_which_there_is_no_report_is_not_observed(told: Told) -> None:
    flown = [task(0), *taken(1000, 1000), task(9000, "Complete")]
    later = (*told[:2], {**told[2], "Epoch": told[2]["Epoch"] + 1})
    for name in ("stays bounded", "flown in time"):
        assert observed(name, *flown).state == "held"
        found = observed(name, *flown, later)
        assert found.state == "not observed"
        assert found.note.startswith("at 5.00 s vehicle 1 is in epoch")
    # nor where none came at all
    assert observed("flown in time", task(0), told, task(9000, "Complete")).state == "not observed"


def test_a_task_that_is_not_seen_to_its_end_may_have_failed() -> None:
    accepted = (0, "PlanAccepted", {"Tasks": [1, 2]})
    one = [task(0), task(9000, "Complete")]
    assert observed("no other failure", accepted, *one).note == "task 2 was not seen to its end"
    assert observed("no other failure", *one, task(9001, task_id=2)).state == "not observed"
    removed = replace(MISSION, changes=(Change(5000, TASK_REMOVED, task=2),))
    assert observed("no other failure", accepted, *one, mission=removed).state == "held"
    both = [*one, task(9001, "Complete", 2, VehicleID=0)]
    assert observed("no other failure", accepted, *both).state == "held"
