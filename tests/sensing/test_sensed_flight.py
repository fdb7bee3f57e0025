"""A flight in which ICAROUS is given what sensors see: the truth is judged, what was sensed stands in the log."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from flight_tools import meeting, of_type

from cratous.bridge import lmcp
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


def test_without_sensors_the_exact_states_are_given_and_that_is_said(sensed: Mission) -> None:
    exact = replace(meeting(), simulation=replace(meeting().simulation, limit_ms=2_000))
    assert of(flown(exact)[0], "SensedState") == []
    assert of_states(exact) == [f"{EXACT_STATES}."]
    assert of_states(replace(exact, instances=())) == []
    assert "normal, independent" in of_states(sensed)[0]
    assert isinstance(sensed.daa, SensedDaa)
