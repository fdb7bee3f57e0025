"""The watch of "items given up": what ICAROUS takes of an item, told message by message."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from flight_tools import meeting

from cratous.bridge import lmcp
from cratous.services.assumptions.observations import Message, Observed
from cratous.services.assumptions.takeover_limit import GivenUpWatch
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS, MOST_TAKEOVERS
from cratous.spec.mission import Change, Mission
from cratous.spec.mission.changes import VEHICLE_HOLDS

MISSION = meeting()
END_MS = 3_600_000
LONGEST_MS = round(1000 * LONGEST_LOOKAHEADS * MISSION.daa.lookahead_s)
Told = tuple[int, str, dict[str, Any]]


def to_item(at_ms: int, task_id: int = 1, phase: str = "Transit") -> Told:
    return at_ms, "TaskProgress", {"TaskID": task_id, "Phase": phase}


def by(owner: str, at_ms: int) -> Told:
    return at_ms, "AuthorityChange", {"Owner": owner}


def taken(*times_ms: int, for_ms: int = 1000) -> list[Told]:
    return [told for at in times_ms for told in (by("ICAROUS", at), by("UxAS", at + for_ms))]


def beats(late_ms: int = 0) -> list[Told]:
    """Heartbeats of ICAROUS, each as late as this."""
    period_ms = MISSION.simulation.heartbeat_ms
    return [
        (sent_ms + late_ms, "Heartbeat", {"Direction": "Up", "Sequence": k})
        for k, sent_ms in enumerate(range(0, END_MS, period_ms), 1)
    ]


def observed(*told: Told, mission: Mission = MISSION, late_ms: int = 0) -> Observed:
    watch = GivenUpWatch(mission)
    for at_ms, kind, fields in sorted([*beats(late_ms), *told], key=lambda one: one[0]):
        body = lmcp.new(f"cratous.{kind}", VehicleID=1, Time=at_ms, **fields)
        watch.message(Message(kind, at_ms, "", body))
    watch.end(END_MS)
    return watch.records()["items given up"].observed(END_MS, True)


OFTEN = [k * 10_000 for k in range(1, MOST_TAKEOVERS + 2)]


def test_as_often_as_is_allowed_and_once_more() -> None:
    found = observed(to_item(0), *taken(*OFTEN))
    assert (found.state, found.extreme) == ("held", MOST_TAKEOVERS + 1)
    found = observed(to_item(0), *taken(*OFTEN, 900_000))
    assert (found.state, found.broken and found.broken.since_ms) == ("broken", 900_000)
    assert found.note == f"takeover {MOST_TAKEOVERS + 2} of vehicle 1 on its way to task 1"


def test_another_item_begins_anew_and_the_same_one_does_not() -> None:
    for phase, task_id, state in (
        ("Transit", 2, "held"),
        ("Active", 1, "broken"),
        ("Transit", 1, "broken"),
    ):
        again = to_item(500_000, task_id, phase)
        found = observed(to_item(0), *taken(*OFTEN), again, *taken(900_000))
        assert (phase, task_id, found.state) == (phase, task_id, state)
    settled = observed(to_item(0), *taken(*OFTEN), to_item(500_000, 1, "Failed"), *taken(900_000))
    assert settled.state == "held"


@pytest.mark.parametrize(("over_ms", "state"), [(1000, "held"), (4000, "broken")])
def test_the_time_under_icarous_has_its_bound_over_all_takeovers(over_ms: int, state: str) -> None:
    two = [*taken(1000, for_ms=100_000), *taken(200_000, for_ms=LONGEST_MS - 100_000 + over_ms)]
    assert observed(to_item(0), *two).state == state
    left_with_it = [by("ICAROUS", 200_000), to_item(200_000 + LONGEST_MS + over_ms - 100_000, 2)]
    one = [*taken(1000, for_ms=100_000), *left_with_it, by("UxAS", 200_000 + LONGEST_MS)]
    assert observed(to_item(0), *one).state == state


def test_who_gives_up_nothing_is_not_held_to_its_time() -> None:
    long = [to_item(0), *taken(1000, for_ms=2 * LONGEST_MS)]
    holds = replace(MISSION, changes=(Change(5000, VEHICLE_HOLDS, vehicle=1),))
    unheard = (2000, "LinkLossState", {})
    assert observed(*long).state == "broken"
    assert observed(*long, mission=holds).state == "not observed"
    assert observed(to_item(0), *taken(*OFTEN, 900_000), mission=holds).state == "not observed"
    found = observed(*long[:2], unheard, *long[2:])
    assert (found.state, found.broken) == ("not observed", None)
    assert found.note.endswith("on its way to task 1, and is not held to its time")
    short = [to_item(0), *taken(1000, for_ms=LONGEST_MS)]
    assert observed(*short[:2], unheard, *short[2:]).state == "held"


def test_what_is_taken_over_without_the_link_counts_on_no_item() -> None:
    def silent(at_ms: int, heard: str = "Linked") -> list[Told]:
        loss = [(at, "LinkLossState", {"Mode": mode}) for at, mode in ((at_ms, "Return"), (at_ms + 500, heard))]  # fmt: skip
        return [loss[0], by("ICAROUS", at_ms), loss[1], by("UxAS", at_ms + 1000)]

    often = [*OFTEN, 900_000]
    losses = [told for at_ms in often for told in silent(at_ms)]
    assert observed(to_item(0), *losses).state == "not observed"
    # heard again, it is counted on
    for times, state in ((OFTEN, "held"), (often, "broken")):
        all_told = [*losses, *taken(*(at_ms + 5000 for at_ms in times))]
        assert observed(to_item(0), *all_told).state == state


def test_what_uxas_heard_of_late_is_not_held_against_its_count() -> None:
    """It gives up by what it has heard: where that is late, more is no fault of the count."""
    long = [to_item(0), *taken(1000, for_ms=LONGEST_MS + 3000)]
    often = [to_item(0), *taken(*OFTEN, 900_000)]
    period_ms = MISSION.simulation.heartbeat_ms
    for told in (long, often):
        assert observed(*told, late_ms=2 * period_ms).state == "broken"
        found = observed(*told, late_ms=5000)
        assert (found.state, found.broken) == ("not observed", None)
        assert "UxAS heard of it late: heartbeat 1 of 0.00 s" in found.note
    assert observed(to_item(0), *taken(*OFTEN), late_ms=5000).state == "held"


def test_nothing_is_observed_where_nobody_is_on_the_way_to_an_item() -> None:
    found = observed(*taken(5000))
    assert (found.state, found.note) == (
        "not observed",
        "no vehicle was taken over on its way to an item",
    )
