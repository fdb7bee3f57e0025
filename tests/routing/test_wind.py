"""Wind in flight: which ground speeds are held, that it is planned for, and that the log says why."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from mission_tools import FRAME_TEXT, vehicle_text

from cratous.bridge import lmcp
from cratous.core.routing.wind import holds_in_wind
from cratous.services.bus import Bus
from cratous.services.cli.job import plan_and_check
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.logs.records import from_data, to_data
from cratous.services.mission.wind import in_wind, known_at, wind_at
from cratous.services.monitor import Monitor
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.changes import words
from cratous.spec.mission.guarantees import Outcome
from cratous.spec.routing import wind

VEHICLES = vehicle_text(1, 0, 400) + vehicle_text(2, 3000, 600, 15, 50)
MISSION = (
    f"""
name: wind
{FRAME_TEXT}vehicles:
{VEHICLES}"""
    + """tasks:
  - {id: 1, kind: must_fly, points: [{north_m: 3000, east_m: 0, alt_m: 400}]}
  - {id: 2, kind: must_fly, points: [{north_m: 3000, east_m: 3000, alt_m: 600}]}
relations: "|(p1 p2)"
changes:
"""
)
STEADY = "  - {at_s: 10, wind: {north_m_s: 6, east_m_s: 0}}\n"
FASTER = "  - {at_s: 20, wind: {north_m_s: 0, east_m_s: -8}}\n"
STORM = "  - {at_s: 30, wind: {north_m_s: 9, east_m_s: 9}}\n"


@pytest.fixture
def write(tmp_path: Path) -> Any:
    def made(*changes: str) -> Mission:
        file = tmp_path / "mission.yaml"
        file.write_text(MISSION + "".join(changes), encoding="utf-8")
        return load(file)

    return made


def test_the_kernel_admits_what_is_held_in_every_direction() -> None:
    asked = admitted = 0
    for ground in (0.0, 10.0, 18.0, 24.0, 25.5, 26.5, 30.0, 35.0, 40.0):
        for strength in (0.0, 1.0, 6.0, 8.5, 12.0):
            for degrees in range(0, 360, 45):
                w = (
                    strength * math.cos(math.radians(degrees)),
                    strength * math.sin(math.radians(degrees)),
                )
                held = holds_in_wind(ground, *w, 18.0 - 1e-9, 35.0 + 1e-9)
                means = all(
                    wind.holds(math.cos(a), math.sin(a), ground, *w, 18.0 - 1e-9, 35.0 + 1e-9)
                    for a in (math.radians(degrees + k) for k in range(0, 360, 30))
                )
                asked, admitted = asked + 1, admitted + held
                assert held == means, (ground, w)
    assert 0 < admitted < asked


def test_limits_narrow_and_the_nearest_speed_is_taken(write: Any) -> None:
    mission = write(STEADY, FASTER, STORM)
    one = mission.vehicles[0]
    steady, faster = in_wind(one, (6.0, 0.0)), in_wind(one, (0.0, -8.0))
    assert steady is not None
    assert faster is not None
    assert steady.speed_m_s == 25
    assert (steady.min_speed_m_s, steady.max_speed_m_s) == pytest.approx((24, 29))
    assert faster.speed_m_s == pytest.approx(26)
    assert in_wind(one, (9.0, 9.0)) is None
    assert wind_at(mission, 9_999) == (0.0, 0.0)
    assert wind_at(mission, 25_000) == (0.0, -8.0)
    assert [v.id for v in known_at(mission, 30_000).vehicles] == [2]
    assert words(mission.changes[1]) == "wind to 0 m/s north, -8 m/s east"
    # the log keeps it as what it is
    assert from_data(Mission, to_data(mission)) == mission


def test_another_wind_is_planned_for_and_the_log_says_what_it_changes(write: Any) -> None:
    mission = replace(write(STEADY, FASTER, STORM), instances=())
    bus, told, speeds = Bus(lmcp.full_names), [], {}
    plan, _ = plan_and_check(mission, bus)
    monitor = Monitor(mission, plan)
    bus.tap(monitor.tap)

    def listen(envelope: Any) -> None:
        body = envelope.body
        if envelope.topic == "cratous.MissionChange":
            told.append((body.Time, body.What, body.Consequence))
        if envelope.topic == "afrl.cmasi.AirVehicleState" and body.ID == 1:
            speeds[body.Time] = body.Groundspeed

    bus.tap(listen)
    result = fly(mission, plan, bus, daa=False)
    assert [time for time, _, _ in told] == [10_000, 20_000, 30_000]
    assert told[0][2] == "the plan holds as it is"
    assert told[1][2] == "planned anew: vehicle 1 holds 26 m/s over the ground instead of 25"
    assert "vehicle 1 can hold no speed over the ground in every direction" in told[2][2]
    assert speeds[9_000] == pytest.approx(25)
    assert speeds[29_000] == pytest.approx(26, abs=0.01)
    assert result.outcome == "complete"
    assert set(result.ends) == {1, 2}
    assert not [v for v in monitor.details() if v.outcome is Outcome.VIOLATED]


def test_a_wind_that_is_none_is_refused(write: Any) -> None:
    with pytest.raises(BadInput):
        write("  - {at_s: 10, wind: {north_m_s: 6}}\n")
    with pytest.raises(BadInput):
        write("  - {at_s: 10, wind: {north_m_s: .nan, east_m_s: 0}}\n")
