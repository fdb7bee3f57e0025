"""A flight in which ICAROUS is given what sensors see: the truth is judged, what was sensed stands in the log."""

from __future__ import annotations

import copy
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from flight_tools import meeting, of_type

from cratous.bridge import lmcp
from cratous.services.assumptions.observation_texts import measured
from cratous.services.assumptions.watch import AssumptionWatch
from cratous.services.bus import Bus, Envelope
from cratous.services.certify.limits import of_states
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.monitor import Monitor
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Mission, SensedDaa
from cratous.spec.mission.guarantees import Outcome
from cratous.spec.mission.sensing import EXACT_STATES


def flown(mission: Mission) -> tuple[list[Envelope], Monitor, int]:
    bus, log, plan = Bus(lmcp.full_names), list[Any](), make_plan(mission)
    monitor = Monitor(mission, plan)
    bus.tap(log.append)
    bus.tap(monitor.tap)
    return log, monitor, fly(mission, plan, bus).takeovers


def seen_in(log: list[Envelope]) -> list[tuple[int, int, float, float]]:
    return [(b.Time, b.TrackID, b.North, b.VelocityEast) for b in of(log, "SensedState")]


def of(log: list[Envelope], name: str) -> list[Any]:
    return of_type([one.body for one in log], name)


@pytest.fixture(scope="module")
def sensed(root: Path) -> Mission:
    return load(root / "examples" / "sensed" / "mission.yaml")


@pytest.fixture(scope="module")
def flight(sensed: Mission) -> tuple[list[Envelope], Monitor, int]:
    return flown(sensed)


def test_it_avoids_by_what_it_sees(flight: tuple[list[Envelope], Monitor, int]) -> None:
    _, monitor, takeovers = flight
    assert takeovers == 1
    assert {v.outcome for v in monitor.verdicts()} == {Outcome.HOLDS}


def test_the_same_mission_gives_the_same_messages(
    sensed: Mission, flight: tuple[list[Envelope], Monitor, int]
) -> None:
    short = replace(sensed, simulation=replace(sensed.simulation, limit_ms=5_000))
    again, other = seen_in(flown(short)[0]), seen_in(flown(replace(short, seed=1))[0])
    assert again
    assert again == seen_in(flight[0])[: len(again)]
    assert {row[:2] for row in again} & {row[:2] for row in other}
    assert not set(again) & set(other)


def test_what_is_sensed_is_not_the_truth_and_within_its_bounds(
    flight: tuple[list[Envelope], Monitor, int],
) -> None:
    log, _, _ = flight
    truth = {(b.Time, b.VehicleID): b for b in of(log, "TruthState")}
    seen = of(log, "SensedState")
    assert {(b.ObserverID, b.TrackID, b.VehicleID) for b in seen} == {(1, 1, 1), (1, 101, 101)}
    apart = []
    for one in seen:
        true = truth[one.Time, one.VehicleID]
        off = math.hypot(one.North - true.North, one.East - true.East)
        apart.append(off)
        assert off <= one.HorizontalBound
        assert abs(one.Altitude - true.Altitude) <= one.VerticalBound
    assert min(apart) > 0
    assert max(apart) > 3
    # 4 standard deviations, once some measurements have come
    assert max(b.HorizontalBound for b in seen[100:]) < 20


NAME = "sensed within its bound"


def watched(mission: Mission, log: list[Envelope]) -> dict[str, Any]:
    """The row of the assumption."""
    watch = AssumptionWatch(mission)
    for one in log:
        watch.tap(one.topic.rpartition(".")[2], one)
    (row,) = [row for row in watch.rows(log[-1].time_ms, True) if row["name"] == NAME]
    return row


def test_the_bounds_are_watched(
    sensed: Mission, flight: tuple[list[Envelope], Monitor, int]
) -> None:
    log = flight[0]
    row = watched(sensed, log)
    assert (row["state"], row["bound"], row["note"]) == ("held", 1.0, "")
    assert row["checks"] == len(of(log, "SensedState"))
    assert 0.2 < row["observed"] < 1
    assert measured(row).endswith(", bound 1")
    (k,) = [
        k
        for k, one in enumerate(log)
        if type(one.body).__name__ == "SensedState"
        and (one.body.Time, one.body.VehicleID) == (60_000, 101)
    ]
    for field, value in (
        ("North", 1e4),
        ("Altitude", 0.0),
        ("HorizontalBound", -1.0),
        ("VerticalBound", math.inf),
    ):
        body = copy.copy(log[k].body)
        setattr(body, field, value)
        row = watched(sensed, [*log[:k], replace(log[k], body=body), *log[k + 1 :]])
        assert (row["state"], row["since_ms"], row["vehicle"]) == ("broken", 60_000, 1)
        assert "what 1 sensed of aircraft 101 is" in row["note"]
    unseen = [
        one
        for one in log
        if type(one.body).__name__ != "TruthState"
        or (one.body.Time, one.body.VehicleID) != (60_000, 101)
    ]
    row = watched(sensed, unseen)
    assert (row["state"], row["since_ms"]) == ("not observed", None)
    assert row["note"].startswith("no true state of aircraft 101 of 60.00 s came by")
    alone = [one for one in log if getattr(one.body, "TrackID", 0) != 101]
    row = watched(sensed, alone)
    assert (row["state"], row["note"]) == ("not observed", "1 never sensed aircraft 101")


def test_an_intruder_that_radar_alone_sees_is_known_by_its_track(sensed: Mission) -> None:
    adsb = sensed.sensing.of_traffic[0] if sensed.sensing else None
    assert isinstance(sensed.daa, SensedDaa)
    assert adsb is not None
    sensors = tuple(one for one in sensed.daa.sensing.sensors if one != adsb)
    daa = replace(sensed.daa, sensing=replace(sensed.daa.sensing, sensors=sensors))
    short = replace(sensed.simulation, limit_ms=75_000)
    log, monitor, takeovers = flown(replace(sensed, daa=daa, simulation=short))
    assert takeovers == 1
    assert {b.TrackID for b in of(log, "SensedState")} == {1, -1}
    assert -1 in {b.IntruderID for b in of(log, "AuthorityChange")}
    rows = {row["name"]: row["state"] for row in monitor.assumptions()}
    assert (rows["intruder in its tube"], rows[NAME]) == ("held", "held")


def test_without_sensors_the_exact_states_are_given_and_that_is_said(sensed: Mission) -> None:
    exact = replace(meeting(), simulation=replace(meeting().simulation, limit_ms=2_000))
    assert of(flown(exact)[0], "SensedState") == []
    assert of_states(exact) == [f"{EXACT_STATES}."]
    assert of_states(replace(exact, instances=())) == []
    assert "normal, independent" in of_states(sensed)[0]
    assert isinstance(sensed.daa, SensedDaa)
