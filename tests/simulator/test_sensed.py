"""Sensors in the simulator: errors, latency, drop-outs and range of what is told, and the own state by GPS."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from simulator_tools import CAMERA, mission, ordered, scenario, waypoint

from cratous.bridge import lmcp
from cratous.services.cli import main
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.sensed import LEAST_PERIOD_MS, Sensed
from cratous.services.simulator.world import Event, World
from cratous.spec.errors import BadInput
from cratous.spec.mission.sensing import Sensing, Sensor, SensorKind

GPS = Sensor(SensorKind.GPS, 3.0, 5.0, 0.3, latency_ms=200)
ADSB = Sensor(SensorKind.ADSB, 10.0, 8.0, 1.0, latency_ms=400, drop_out=0.2)
RADAR = Sensor(SensorKind.RADAR, 15.0, 12.0, 2.0, period_ms=500, range_m=3000.0)
ALL = Sensing((GPS, ADSB, RADAR), seed=3)
SECTION = """sensing:
  sensors:
    - {kind: gps, horizontal_m: 3, vertical_m: 5, velocity_m_s: 0.3}
    - {kind: adsb, horizontal_m: 10, vertical_m: 8, velocity_m_s: 1}
"""
NORTH_M = 111_200.0
"""Of a degree, about."""


def world(sensing: Sensing | None, other_lat: float = 45.02, **how: Any) -> World:
    """Two aircraft that fly north, the second some kilometres ahead; one turns."""
    plan = of_text(scenario(mission(waypoint(1, 2, 45.03), waypoint(2, 2, 45.5))), "test")
    body = [event.body for event in plan.events[:2]]
    at = body[1].Location.copy(Latitude=other_lat)
    other = body[0].copy(ID=2), body[1].copy(ID=2, Location=at)
    events = [*plan.events, *(Event(0.0, one, "") for one in other)]
    return World(events, 600, sensed=sensing and Sensed(sensing), **how)


def told(one: World, until_s: float) -> Iterator[tuple[int, Any]]:
    """What it tells, with the instant [ms]."""
    while one.time_s < until_s:
        yield from [(one.time_ms, body) for body in one.tick()]


def off_m(place: Any, true: Any) -> tuple[float, float, float]:
    """North, east, up [m]."""
    around = NORTH_M * math.cos(math.radians(true.Latitude))
    return (
        (place.Latitude - true.Latitude) * NORTH_M,
        (place.Longitude - true.Longitude) * around,
        place.Altitude - true.Altitude,
    )


def truth(until_s: float) -> dict[int, dict[int, Any]]:
    """Places by vehicle and instant, each step; told by a world without sensors that flies the same."""
    one, found = world(None), dict[int, dict[int, Any]]()
    while one.time_s < until_s:
        at = one.time_ms + 10
        for state in one.states():
            found.setdefault(state.ID, {})[at] = state.Location
        one.tick()
    return found


def test_what_comes_of_others_has_the_errors_latency_drop_outs_and_range_of_its_sensor() -> None:
    until_s, true = 300.0, truth(300.0)
    seen = [
        (at, body) for at, body in told(world(ALL), until_s)
        if type(body).__name__ == "EntityPerception"
    ]  # fmt: skip
    by_name = [(at, b) for at, b in seen if b.PerceivedEntityID]
    assert {(b.PerceiverID, b.PerceivedEntityID) for _, b in by_name} == {(1, 2), (2, 1)}
    # 1 Hz both ways for 300 s, of which a fifth does not come
    assert len(by_name) == pytest.approx(600 * 0.8, rel=0.08)
    assert all(400 <= at - b.TimeLastSeen <= 400 + LEAST_PERIOD_MS for at, b in by_name)
    offs = np.array(
        [off_m(b.Location, true[b.PerceivedEntityID][b.TimeLastSeen]) for _, b in by_name]
    )
    assert np.std(offs, axis=0) == pytest.approx([10, 10, 8], rel=0.15)
    assert abs(np.mean(offs, axis=0)) == pytest.approx([0, 0, 0], abs=2)
    one = by_name[0][1]
    assert list(one.LocationError) == [10, 10, 8]
    assert list(one.VelocityError) == [1, 1, 1]
    assert (one.VelocityValid, one.AttitudeValid, list(one.PerceiverPayloads)) == (True, False, [])
    speeds = np.array([b.Velocity for _, b in by_name if b.PerceivedEntityID == 2])
    assert np.std(speeds[:, 2]) == pytest.approx(1.0, rel=0.2)
    early = [b.Velocity for _, b in by_name if b.PerceivedEntityID == 2 and b.TimeLastSeen < 20_000]
    (_, *_, fast) = (
        b.Groundspeed for _, b in told(world(None), 20) if type(b).__name__ == "AirVehicleState"
    )
    assert np.mean(early, axis=0) == pytest.approx([fast, 0, 0], abs=2), "it flies north"
    nameless = [b for _, b in seen if not b.PerceivedEntityID]
    # 2.2 km apart: twice a second, all of it
    assert len(nameless) == pytest.approx(1200, abs=8)
    assert list(nameless[0].LocationError) == [15, 15, 12]
    far = [b for _, b in told(world(ALL, 45.04), 20) if type(b).__name__ == "EntityPerception"]
    assert {b.PerceivedEntityID for b in far} == {1, 2}, "4.4 km are out of the radar's range"


def test_a_state_says_where_its_gps_has_it_and_it_flies_by_the_truth() -> None:
    true = truth(300.0)
    with_sensors, plain = world(ALL), world(None)
    states = [b for _, b in told(with_sensors, 300) if type(b).__name__ == "AirVehicleState"]
    exact = [b for _, b in told(plain, 300) if type(b).__name__ == "AirVehicleState"]
    assert {k: a.motion for k, a in with_sensors.aircraft.items()} == {
        k: a.motion for k, a in plain.aircraft.items()
    }
    assert [(b.ID, b.Time, b.Heading, b.Mode) for b in states] == [
        (b.ID, b.Time, b.Heading, b.Mode) for b in exact
    ]
    later = [b for b in states if b.Time > 20_000]
    offs = np.array([off_m(b.Location, true[b.ID][b.Time]) for b in later])
    # fixes of 3 and 5 m each second, carried on by an inertial unit: not the truth, and better than a fix
    assert np.all(np.std(offs, axis=0) > 0.1)
    assert np.all(np.std(offs, axis=0) < [2, 2, 3])
    assert np.max(abs(offs)) < 10
    exactly = [b for b in exact if b.Time > 20_000]
    assert max(abs(a.Groundspeed - b.Groundspeed) for a, b in zip(later, exactly, strict=True)) < 1
    turned = [
        abs((a.Course - b.Course + 180) % 360 - 180) for a, b in zip(later, exactly, strict=True)
    ]
    assert max(turned) < 5
    own = world(replace(ALL, sensors=(ADSB,)))
    (a, b) = (
        [x for _, x in told(w, 10) if type(x).__name__ == "AirVehicleState"]
        for w in (own, world(None))
    )
    assert [lmcp.binary.pack(x) for x in a] == [lmcp.binary.pack(x) for x in b], "no GPS: exact"


def test_the_same_seed_tells_the_same_bytes_and_another_one_others() -> None:
    def all_bytes(sensing: Sensing) -> list[bytes]:
        return [lmcp.binary.pack(body) for _, body in told(world(sensing), 20)]

    assert all_bytes(ALL) == all_bytes(ALL)
    assert all_bytes(ALL) != all_bytes(replace(ALL, seed=4))


def test_a_gimbal_tracks_what_adsb_tells() -> None:
    track = """<TrackEntityAction Series="PERCEIVE"><EntityID>2</EntityID><SensorID>2</SensorID></TrackEntityAction>"""
    plan = of_text(scenario(ordered(1, track), payloads=CAMERA), "test")
    body = [event.body for event in plan.events[:2]]
    at = body[1].Location.copy(Longitude=-119.99, Altitude=300.0)
    other = body[0].copy(ID=2, PayloadConfigurationList=[]), body[1].copy(ID=2, Location=at)
    events = [*plan.events, *(Event(0.0, one, "") for one in other)]
    steady = replace(ADSB, drop_out=0.0)
    for sensing, wanted in ((None, 0.0), (Sensing((steady,)), 90.0)):
        one = World(events, 600, sensed=sensing and Sensed(sensing))
        states = [
            b for _, b in told(one, 10) if type(b).__name__ == "AirVehicleState" and b.ID == 1
        ]
        assert states[-1].PayloadStateList[0].Azimuth == pytest.approx(wanted, abs=15)


def test_an_aircraft_too_far_for_one_frame_is_named() -> None:
    with pytest.raises(BadInput) as refused:
        list(told(world(ALL, 65.0), 2))
    assert refused.value.item == "AirVehicleState 2"
    assert "within 2000 km of 45.00001, -120.00000" in str(refused.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (SECTION.replace("kind: adsb", "kind: lidar"), ("sensors.yaml:4", "sensing.sensors[1].kind", "lidar")),
        (SECTION.replace("_s: 1}", "_s: 1, period_s: 0.02}"), ("sensing.sensors[1].period_s", "at least 0.04 s", "0.02 s")),
        (SECTION.replace("kind: adsb", "kind: gps"), ("sensing.sensors", "no sensor sees traffic")),
        ("name: none\n", ("sensing", "missing")),
        ("[", ("sensors.yaml", "YAML")),
        (None, ("sensors.yaml",)),
    ],
)  # fmt: skip
def test_bad_sensors_are_named_by_file_and_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str | None, said: tuple[str, ...]
) -> None:
    file, sensors = tmp_path / "s.xml", tmp_path / "sensors.yaml"
    file.write_text(scenario())
    if text is not None:
        sensors.write_text(text)
    assert main(["sim", str(file), "--until", "1", "--sensing", str(sensors)]) == 2
    error = capsys.readouterr().err
    assert all(word in error for word in said), error


def test_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, sensors = tmp_path / "s.xml", tmp_path / "sensors.yaml"
    file.write_text(scenario())
    sensors.write_text(SECTION)
    plain, noisy = tmp_path / "plain.bin", tmp_path / "noisy.bin"
    command = ["sim", str(file), "--until", "5"]
    assert main([*command, "-o", str(plain)]) == 0
    assert main([*command, "-o", str(noisy), "--sensing", str(sensors)]) == 0
    assert plain.read_bytes() != noisy.read_bytes()
    assert main([*command, "--sensing", str(sensors), "--compatibility", "amase"]) == 2
    assert "AMASE has no such sensors" in capsys.readouterr().err
