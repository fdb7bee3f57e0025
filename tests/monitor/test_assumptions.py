"""The assumptions of the system theorems: each watch sees its own broken, and says nothing of what it did not see."""

from __future__ import annotations

import copy
import json
from dataclasses import replace
from typing import Any

import pytest
from assumption_logs import LIMIT_MS, WHOLE, flown, judged, tampered
from broken_assumptions import (
    BREAKS,
    STILL,
    WATCHED,
    aside,
    late_beat,
    never_offered,
    overlooked,
    sent,
    taken_ms,
    with_faults,
)
from flight_tools import meeting
from mission_tools import must_fly
from tampering import (
    Log,
    at,
    other,
)

from cratous.services.assumptions.listing import LISTING
from cratous.services.assumptions.observation_texts import sentence
from cratous.services.assumptions.takeover_ends import HEARD_MS, LEAST_MS
from cratous.services.assumptions.watch import AssumptionWatch
from cratous.services.icarous.instance import LINK_LOST_MS
from cratous.services.icarous.return_to_path import PERSIST_MS
from cratous.services.monitor import Monitor
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import (
    Mission,
    Position,
    Simulation,
    Zone,
    ZoneKind,
)


def test_a_flight_in_which_all_hold() -> None:
    rows = judged(WHOLE, list(flown(WHOLE)))
    held = {name for name, row in rows.items() if row["state"] == "held"}
    assert WATCHED - held == {
        "suspended",
        "takeovers told",
        "sensed within its bound",
        "near its legs",
    }
    assert rows["near its legs"]["note"] == "no zone for a vehicle that is protected"
    assert "the exact states" in rows["sensed within its bound"]["note"]
    assert rows["suspended"]["note"] == "no task was suspended"
    assert rows["takeovers told"]["note"] == "UxAS sent no command in an epoch that was over"
    for name in held:
        row = rows[name]
        assert row["checks"] > 0
        assert (row["since_ms"], row["lost"], row["stands"], row["note"]) == (None, "", "", "")
        assert row["observed"] is None or row["observed"] <= row["bound"]
    assert rows["intruder in its tube"]["bound"] == 150 * 0.25 / 2
    assert 0 < min(rows[n]["observed"] for n in ("tracking", "flown as looked at")) < 2
    assert 0.5 < rows["permitted as offered"]["observed"] < 1


def test_each_watch_has_a_log_in_which_its_assumption_breaks() -> None:
    assert {*BREAKS, "near its legs"} == WATCHED  # that one needs a zone: test_near_its_legs


def rows_told(mission: Mission, log: Log, of_every_kind: bool) -> list[Any]:
    """What is said at each message, and at the end."""
    watching = AssumptionWatch(mission)
    if of_every_kind:
        watching._by_kind = {m.topic.rpartition(".")[2]: watching._watches for m in log}
    told = [watching.tap(m.topic.rpartition(".")[2], m) for m in log]
    return [*told, watching.rows(log[-1].time_ms, True)]


@pytest.mark.parametrize("name", ["", *sorted(BREAKS)])
def test_a_watch_that_is_told_of_every_message_says_the_same(name: str) -> None:
    """No watch reads a type that it does not list."""
    east = ((2000.0, 0.5), (4000.0, 0.5), (4000.0, 900.0), (2000.0, 900.0))
    mission = replace(WHOLE, zones=(Zone(21, ZoneKind.KEEP_OUT, east, 0.0, 1000.0),))
    log = [copy.copy(one) for one in flown(WHOLE)]
    if name:
        BREAKS[name][0](log)
    few, every = (rows_told(mission, log, of_all) for of_all in (False, True))
    assert few == every
    (near,) = [row for row in few[-1] if row["name"] == "near its legs"]
    assert near["checks"] > 100


@pytest.mark.parametrize("name", sorted(BREAKS))
def test_what_is_broken_is_said_with_when_and_what_is_lost(name: str) -> None:
    change, text = BREAKS[name]
    row = tampered(change)[name]
    assert (row["state"], text in row["note"]) == ("broken", True), row
    (one,) = [one for one in LISTING if one.name == name]
    assert (row["lost"], row["stands"]) == (one.lost, one.stands)
    assert all(row[key] for key in ("lost", "stands", "guarantees"))
    assert isinstance(row["since_ms"], int)
    said = sentence(row)
    assert f"{row['since_ms'] / 1000:.2f} s" in said
    assert one.lost in said
    assert row["guarantees"][0] in said


@pytest.mark.parametrize(
    ("name", "since_ms"),
    [
        ("heartbeat period", 10_000),
        ("delivery from ICAROUS", 11_000),
        ("end of the flight", LIMIT_MS + 250),
        ("clock", 41_500),  # where the tampered command was
    ],
)
def test_since_is_the_first_instant_at_which_it_does_not_hold(name: str, since_ms: int) -> None:
    found = tampered(BREAKS[name][0])[name]["since_ms"]
    assert 0 <= found - since_ms < 500


def test_within_the_bound_nothing_is_broken() -> None:
    def change(log: Log) -> None:
        aside(90, taken_ms() + 3000, East=18.0, Altitude=3.5)(log)
        sent(log, taken_ms() + 500, "uxas/executive", kind="GatedCommand", VehicleID=1, Epoch=0,
             Sender="UxAS")  # fmt: skip

    rows = tampered(change)
    assert rows["intruder in its tube"]["state"] == rows["takeovers told"]["state"] == "held"
    assert rows["intruder in its tube"]["observed"] == pytest.approx(18.0)
    assert rows["takeovers told"]["observed"] == 0.5


def test_the_tube_counts_altitude_by_its_own_bound() -> None:
    row = tampered(aside(90, taken_ms() + 3000, Altitude=-4.0))["intruder in its tube"]
    assert row["state"] == "broken"
    assert row["since_ms"] == taken_ms() + 3000


@pytest.mark.parametrize(
    ("faults", "broken"),
    [
        ({"delay_ms": 5000}, {"delivery from ICAROUS"}),
        ({"loss": 0.4}, {"delivery from ICAROUS"}),
        (
            {"cut_ms": 20_000},
            {"delivery from ICAROUS", "delivery to ICAROUS", "heartbeat period"},
        ),
        ({"stops_reading_ms": 20_000, "reads_again_ms": 23_500}, {"delivery to ICAROUS"}),
    ],
)
def test_faults_of_the_bridge_break_what_is_assumed_of_the_link(
    faults: dict[str, Any], broken: set[str]
) -> None:
    mission = with_faults(**faults)
    rows = judged(mission, list(flown(mission)))
    found = {name for name, row in rows.items() if row["state"] == "broken"}
    # the flight ends at its limit, long before its task
    unserved = {"flown in time", "no other failure"}
    often = {"offers taken", "takeovers told", "intruder in its tube"}
    assert broken <= found <= broken | often | unserved
    for name in {"delivery from ICAROUS"} & broken:
        assert rows[name]["observed"] > rows[name]["bound"] == 1.0
    for name in {"delivery to ICAROUS"} & broken:
        assert rows[name]["observed"] > rows[name]["bound"] == 2.0
        assert 0 <= rows[name]["since_ms"] - 21_000 <= 1000
    if "cut_ms" in faults:
        assert rows["heartbeat period"]["since_ms"] == 20_000 + 500
    for name in ("epochs kept", "epochs told", "first command", "clock"):
        assert rows[name]["state"] != "broken", "no loss or delay touches these"


def test_what_was_not_watched_to_the_end_did_not_hold() -> None:
    log = list(flown(WHOLE))
    rows = judged(WHOLE, log[: at(log, "MissionEnd")])
    assert {row["state"] for row in rows.values()} == {"not observed"}
    assert "the messages stop at" in rows["clock"]["note"]
    assert {row["state"] for row in judged(WHOLE, []).values()} == {"not observed"}
    only_end = judged(WHOLE, log[at(log, "MissionEnd") :])
    assert "held" not in {only_end[name]["state"] for name in WATCHED - {"clock"}}


def test_without_icarous_nothing_is_said_to_hold_of_it() -> None:
    mission = replace(WHOLE, instances=())
    rows = judged(mission, list(flown(mission)))
    for name in ("delivery from ICAROUS", "heartbeat period", "intruder in its tube", "tracking"):
        assert rows[name]["state"] == "not observed"
        assert rows[name]["note"] == "no vehicle has an ICAROUS instance"


def test_a_certificate_that_is_not_so_is_seen_under_icarous_too() -> None:
    row = tampered(lambda log: overlooked(log, taken_ms() + 8000))["permitted as offered"]
    assert row["state"] == "broken"
    assert "aircraft 91, though a certificate is in hand until" in row["note"]
    assert taken_ms() < row["since_ms"] <= taken_ms() + 8000


def test_what_is_hit_after_it_flew_otherwise_is_not_blamed_on_what_was_permitted() -> None:
    def change(log: Log) -> None:
        aside(90, 5000, East=20.0)(log)
        overlooked(log)

    row = tampered(change)["permitted as offered"]
    assert row["state"] == "not observed"
    assert "after 'flown as looked at' was broken" in row["note"]


def test_a_certificate_ends_in_the_log_where_it_says_so() -> None:
    """Without one nothing was promised: what then comes near breaks nothing of this."""

    def change(log: Log) -> None:
        for k, one in enumerate(log):
            if one.topic.endswith("HandState"):
                log[k] = other(one, Expiry=taken_ms())
        overlooked(log, taken_ms() + 8000)

    row = tampered(change)["permitted as offered"]
    assert row["state"] == "held"


@pytest.mark.parametrize(
    ("kind", "names"),
    [
        ("GateState", ("stays bounded", "flown in time", "permitted as offered")),
        ("HandState", ("permitted as offered",)),
        ("TaskProgress", ("stays bounded", "flown in time", "no other failure")),
    ],
)
def test_nothing_holds_of_what_messages_that_are_missing_would_say(
    kind: str, names: tuple[str, ...]
) -> None:
    def change(log: Log) -> None:
        log[:] = [one for one in log if not one.topic.endswith(f".{kind}")]

    rows = tampered(change)
    assert {name: rows[name]["state"] for name in names} == dict.fromkeys(names, "not observed")


def test_how_long_a_takeover_waits_is_told_from_one_that_was_too_short() -> None:
    log = [copy.copy(one) for one in flown(WHOLE)]
    never_offered(log)
    end = log.pop(at(log, "MissionEnd"))
    soon_ms = taken_ms() + 20_000
    cut = [*(one for one in log if one.time_ms <= soon_ms)]
    cut.append(replace(other(end, Time=soon_ms), time_ms=soon_ms))
    row = judged(WHOLE, cut)["way back free"]
    assert (row["state"], "too short to tell" in row["note"]) == ("not observed", True)
    deaf = [copy.copy(one) for one in log]
    sent(deaf, taken_ms() + 1000, "icarous/1", kind="UxasHeard", VehicleID=1,
         Time=taken_ms() + 1000, Heard=False, Last=taken_ms())  # fmt: skip
    row = judged(WHOLE, [*deaf, end])["way back free"]
    assert (row["state"], "did not hear UxAS" in row["note"]) == ("not observed", True)


def test_an_intruder_that_stays_beside_the_way_leaves_no_way_back() -> None:
    """It hovers where the task is: control is never offered for long, and the limit ends the flight."""
    base = meeting()
    stands = replace(base.traffic[0], position=Position(2600.0, 0.0, 300.0), velocity=STILL)
    goal = must_fly(1, (2600.0, 0.0, 300.0), label="there")
    short = Simulation(limit_ms=200_000)
    mission = replace(base, traffic=(stands,), tasks=(goal,), simulation=short)
    rows = judged(mission, list(flown(mission)))
    assert rows["way back free"]["state"] == "broken", rows["way back free"]
    assert rows["delivery to ICAROUS"]["state"] == "held"


def test_the_bounds_are_those_that_icarous_goes_by() -> None:
    assert (LEAST_MS, HEARD_MS) == (PERSIST_MS, LINK_LOST_MS)


def test_an_icarous_that_does_not_say_what_it_hears_leaves_that_open() -> None:
    watch = AssumptionWatch(WHOLE, on_board=False)
    for one in flown(WHOLE):
        watch.tap(one.topic.rpartition(".")[2], one)
    rows = {row["name"]: row for row in watch.rows(LIMIT_MS, True)}
    for name in ("delivery to ICAROUS", "way back free"):
        assert rows[name]["note"] == "this ICAROUS does not say whether it hears UxAS"


def test_an_intruder_or_a_vehicle_that_is_not_seen_is_not_said_to_be_in_its_place() -> None:
    for number, name in ((90, "intruder in its tube"), (1, "tracking")):
        now_ms = taken_ms() + 2000
        gone = {now_ms + 250 * k for k in range(8)}

        def change(log: Log, number: int = number, gone: set[int] = gone) -> None:
            log[:] = [
                one
                for one in log
                if not (
                    one.topic.endswith("TruthState")
                    and one.time_ms in gone
                    and one.body.VehicleID == number
                )
            ]

        row = tampered(change)[name]
        assert (row["state"], "not seen" in row["note"]) == ("not observed", True)


def test_a_vehicle_that_gets_no_command_is_named() -> None:
    second = replace(WHOLE.vehicles[0], id=2)
    mission = replace(WHOLE, vehicles=(*WHOLE.vehicles, second))
    row = judged(mission, list(flown(WHOLE)))["first command"]
    assert (row["state"], row["note"]) == ("not observed", "no command to vehicle 2 was seen")


def test_messages_without_a_sender_leave_open_who_reports() -> None:
    rows = tampered(lambda log: log.__setitem__(slice(None), [replace(o, source="") for o in log]))
    assert rows["reports of the gate"]["note"] == "the messages do not name their senders"


@pytest.mark.parametrize("far", [1e308, -1e308])
def test_places_and_speeds_that_no_aircraft_has_are_told_in_numbers(far: float) -> None:
    def change(log: Log) -> None:
        now_ms = taken_ms()
        fields = ("North", "East", "Altitude", "VelocityNorth", "VelocityEast", "VelocityDown")
        for number in (1, 90):
            for k in (0, 4, 5):
                aside(number, now_ms + 250 * k, **dict.fromkeys(fields, far * (-1) ** k))(log)

    log = [copy.copy(one) for one in flown(WHOLE)]
    change(log)
    watch = AssumptionWatch(WHOLE)
    for one in log:
        watch.tap(one.topic.rpartition(".")[2], one)
    rows = {row["name"]: row for row in watch.rows(log[-1].time_ms, True)}
    for name in ("intruder in its tube", "tracking"):
        assert rows[name]["state"] == "broken"
        json.dumps(rows[name], allow_nan=False)


def test_a_break_is_told_once_at_the_moment_it_is_seen() -> None:
    told: list[tuple[str, int]] = []
    log = [copy.copy(one) for one in flown(WHOLE)]
    late_beat(log)
    now = [0]
    monitor = Monitor(
        WHOLE, make_plan(WHOLE), on_broken=lambda row: told.append((row["name"], now[0]))
    )
    for one in log:
        now[0] = one.time_ms
        monitor.tap(one)
    ((name, at_ms),) = told
    assert name == "delivery from ICAROUS"
    assert 11_000 < at_ms <= 11_500
