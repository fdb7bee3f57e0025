"""The modes of the decision logic as the report tells them."""

from __future__ import annotations

from typing import Any

from cratous.core.authority.cognition import Conditions
from cratous.services.certify.evidence import counted
from cratous.services.certify.modes import OTHERWISE, note, spans
from cratous.services.certify.picture import time_view


def said(time_ms: int, mode: str, way: str = "NoResolution", **more: Any) -> dict[str, Any]:
    conditions = {name.capitalize(): False for name in Conditions._fields}
    body = {"VehicleID": 1, "Time": time_ms, "Mode": mode, "Resolution": way, "Skipped": 0}
    return {**body, "IntruderID": 0, **conditions, **more}


def told(*bodies: dict[str, Any]) -> list[dict[str, Any]]:
    modes: list[dict[str, Any]] = []
    for body in bodies:
        note(modes, body)
    return spans(modes, 9000)


FLOWN = (
    said(1000, "TrafficConflict", "Turn", Traffic=True, IntruderID=7),
    said(4000, "NextWaypoint", Has=True, Skips=True, Skipped=3),
    said(4500, "Nominal", VehicleID=2),
    said(6000, "Nominal"),
)


def test_each_mode_lasts_until_the_next_one_of_its_vehicle() -> None:
    first, then, last, other = told(*FLOWN)
    assert (first["mode"], first["way"], first["intruder"]) == ("traffic conflict", "by a turn", 7)
    assert (first["from_ms"], first["to_ms"], first["group"]) == (1000, 4000, "avoids")
    assert first["why"] == "traffic forbids what would be flown"
    assert (then["mode"], then["group"]) == ("next waypoint", "back")
    assert then["why"] == "ICAROUS has the vehicle; 3 waypoints are left out"
    assert (last["mode"], last["why"], last["to_ms"]) == ("nominal", "", 9000)
    assert (other["vehicle"], other["from_ms"], other["to_ms"]) == (2, 4500, 9000)


def test_a_mode_that_the_kernel_does_not_make_of_its_conditions_says_so() -> None:
    (nominal,) = told(said(0, "Nominal", Traffic=True))
    assert nominal["why"].endswith(OTHERWISE)
    landed, left = told(said(0, "Landed", Landed=True), said(500, "Nominal"))
    assert OTHERWISE not in landed["why"]
    assert OTHERWISE in left["why"]  # who has landed stays there


def test_who_reads_a_flight_while_calls_are_counted_adds_none() -> None:
    modes: list[dict[str, Any]] = []
    with counted() as calls:
        note(modes, said(0, "Nominal", Traffic=True))
    assert calls.data()["called"] == {}
    assert OTHERWISE in spans(modes, 9000)[0]["why"]


def test_the_time_line_draws_all_modes_but_the_nominal_one() -> None:
    flight = {"end_ms": 9000, "bars": [], "modes": told(*FLOWN)}
    mission = {"vehicles": [{"id": 1, "label": "one"}]}
    drawn = time_view({"flight": flight, "mission": mission})["modes"]
    assert [one["mode"] for one in drawn] == ["traffic conflict", "next waypoint"]
    assert drawn[0]["x"] < drawn[1]["x"]
    without = {"end_ms": 9000, "bars": []}
    assert time_view({"flight": without, "mission": mission})["modes"] == []
