"""What the real OpenUxAS needs of the simulator, and commands of it that AMASE flew by.

`uxas_waterway.jsonl.gz`: two minutes of OpenUxAS's waterway example on OpenAMASE at twice real time, one
LMCP message a line: `sent` what came in and when [s], `told` every twentieth pair of states [ms].
"""

from __future__ import annotations

import contextlib
import gzip
import json
import math
import socket
import time
from collections import deque
from pathlib import Path
from typing import Any

import pytest
from simulator_tools import DIRECTOR, mission, ordered, scenario, waypoint
from uxas_tools import Client, free_port

from cratous.bridge import lmcp
from cratous.bridge.port import Address, address
from cratous.services.cli import main
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.server import Server
from cratous.services.simulator.world import Event, World
from cratous.spec.errors import BadInput

RECORDED = Path(__file__).parent / "uxas_waterway.jsonl.gz"
FLIGHT = mission(waypoint(1, 2, 45.02), waypoint(2, 2, 45.1))
PLACE = address("tcp://127.0.0.1:0", ("tcp",), free=True)


def tick_of(state: Any) -> int:
    """Number of the tick at which a state was told; milliseconds are cut off, now and then one too many."""
    return int(state.Time + 5) // 10


def test_commands_of_openuxas_are_flown_as_amase_flew_them() -> None:
    """Tracks, turns, gimbals and what the states say of the mission; the commands' times are those of a
    recording, to some 10 ms, so that places are near and not the same."""
    events, wanted = [], []
    with gzip.open(RECORDED, "rt") as lines:
        for line in map(json.loads, lines):
            body = lmcp.binary.unpack(bytes.fromhex(line["lmcp"]))
            if "told" in line:
                wanted.append(body)
            else:
                events.append(Event(line["sent"], body, "recording"))
    world = World((), 118, compatible=True)
    left, told = deque(sorted(events, key=lambda one: one.time_s)), {}
    while not world.over:
        while left and left[0].time_s <= world.time_s:
            world.receive(left.popleft().body)
        for body in world.tick():
            if type(body).__name__ == "AirVehicleState":
                told[body.ID, tick_of(body)] = body
    assert len(wanted) > 20
    for theirs in wanted:
        ours = told[theirs.ID, tick_of(theirs)]
        north = (ours.Location.Latitude - theirs.Location.Latitude) * 111_200
        east = (ours.Location.Longitude - theirs.Location.Longitude) * 78_200
        assert math.hypot(north, east) < 0.5
        for name in ("CurrentWaypoint", "CurrentCommand", "Mode", "AssociatedTasks"):
            assert getattr(ours, name) == getattr(theirs, name), name
        for name in "pqr":
            assert getattr(ours, name) == pytest.approx(getattr(theirs, name), abs=0.02)
        for one, other in zip(ours.PayloadStateList, theirs.PayloadStateList, strict=True):
            assert one.PointingMode == other.PointingMode
            assert one.Elevation == pytest.approx(other.Elevation, abs=0.5)


def test_rates_of_turn_are_those_of_the_attitude() -> None:
    """Degrees per second about the axes of the body, in a banked climb; AMASE tells others."""
    world = World(of_text(scenario(ordered(2, DIRECTOR)), "x").events, 60)
    before, turned = None, 0.0
    while not world.over:
        for body in world.tick():
            if type(body).__name__ == "AirVehicleState":
                turned = max(turned, abs(body.r))
        one = world.aircraft.get(1)
        if one is None or one.motion == before:
            continue
        m = one.motion
        if before is not None and world.time_s > 5:
            (body,) = world.states()
            pitch, roll = m.pitch_rad, m.roll_rad
            p, q, r = (math.radians(x) for x in (body.p, body.q, body.r))
            wanted = {
                "heading": (q * math.sin(roll) + r * math.cos(roll)) / math.cos(pitch),
                "pitch": q * math.cos(roll) - r * math.sin(roll),
                "roll": p + math.tan(pitch) * (q * math.sin(roll) + r * math.cos(roll)),
            }
            for name, rate in wanted.items():
                change = getattr(m, f"{name}_rad") - getattr(before, f"{name}_rad")
                change = math.remainder(change, math.tau)
                assert change * 30 == pytest.approx(rate, abs=1e-6), name
        before = m
    assert turned > 5, "it has turned"


def serving(*, compatible: bool = False, vehicles: dict[int, Address] | None = None) -> Server:
    plan = of_text(scenario(FLIGHT), "test")
    return Server(
        lambda: World(plan.events, 600, compatible=compatible),
        PLACE,
        lambda *_: None,
        vehicles=vehicles,
    )


def turn(server: Server, seconds: float) -> None:
    for _ in range(int(seconds * 10)):
        server.turn(time.monotonic(), 0.1)


@pytest.mark.parametrize("compatible", [False, True])
def test_in_amase_nobody_is_told_what_happens_on_loading(compatible: bool) -> None:
    """A client that was there first plans with tasks and a request of time 0 before it has its own."""
    server = serving(compatible=compatible)
    assert len(server.world.aircraft) == compatible, "it has happened"
    with contextlib.closing(server.port), contextlib.closing(Client(server.port.bound[1])) as one:
        turn(server, 3)
        kinds = one.kinds()
        assert kinds.count("AirVehicleConfiguration") == 1, "told to who comes late"
        assert kinds[0] == "AirVehicleConfiguration"
        assert (kinds[1] == "AirVehicleState") is not compatible, "the event of time 0"
        assert "MissionCommand" in kinds
        one.send(lmcp.new("SessionStatus", State="Reset"))
        turn(server, 1)
        again = one.kinds()[len(kinds) :]
        assert ("AirVehicleConfiguration" in again) is compatible, "as it is loaded anew"


def test_a_vehicle_has_a_port_of_its_own() -> None:
    """Its clients see it alone, and command it; what they send the others are told."""
    server = serving(vehicles={1: PLACE, 9: PLACE})
    common, own, other = (
        Client(port.bound[1]) for port in (server.port, *server.vehicle_ports.values())
    )
    with contextlib.ExitStack() as after:
        for end in (common, own, other, server.port, *server.vehicle_ports.values()):
            after.callback(end.close)
        turn(server, 3)
        assert set(own.kinds()) == {"AirVehicleConfiguration", "AirVehicleState"}
        assert own.kinds().count("AirVehicleConfiguration") == 1
        assert not other.kinds(), "a vehicle that is not there"
        command = of_text(scenario(ordered(0, DIRECTOR)), "x").events[-1].body
        own.send(command)
        own.send(lmcp.new("WeatherReport", WindSpeed=3.0))
        turn(server, 2)
        assert server.world.aircraft[1].guidance.directed_id == 8
        assert common.kinds().count("VehicleActionCommand") == 1
        assert "VehicleActionCommand" not in own.kinds(), "not to the sender"
        common.send(command)
        turn(server, 2)
        assert own.kinds().count("VehicleActionCommand") == 1
        assert other.kinds() == ["WeatherReport"]


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--vehicle", "1=127.0.0.1:0"], "--listen as well"),
        (["--listen", "127.0.0.1:0", "--only", "1", "--vehicle", "1=127.0.0.1:0"], "no --only"),
        (["--listen", "127.0.0.1:0", "--vehicle", "one=127.0.0.1:0"], "ID=HOST:PORT"),
        (["--listen", "127.0.0.1:0", "--vehicle", "1=127.0.0.1"], "not an address"),
        (
            ["--listen", "127.0.0.1:0", "--vehicle", "1=127.0.0.1:0", "--vehicle", "1=[::1]:0"],
            "each ID once",
        ),
    ],
)
def test_a_port_of_a_vehicle_that_cannot_be(
    more: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "s.xml"
    path.write_text(scenario(FLIGHT))
    assert main(["sim", str(path), *more]) == 2
    assert said in capsys.readouterr().err


def test_a_port_of_a_vehicle_that_the_scenario_does_not_have_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("signal.signal", lambda *_: None)
    monkeypatch.setattr(Server, "run", lambda self: self._close())
    path = tmp_path / "s.xml"
    path.write_text(scenario(FLIGHT))
    ports = ["--vehicle", "1=127.0.0.1:0", "--vehicle", "7=127.0.0.1:0"]
    assert main(["sim", str(path), "--listen", "127.0.0.1:0", *ports]) == 0
    said = capsys.readouterr().err
    assert "--vehicle 7: the scenario has no such vehicle (it has 1)" in said
    assert "--vehicle 1" not in said


def test_a_port_that_is_taken_leaves_none_open() -> None:
    mine = "127.0.0.1", free_port()
    with contextlib.closing(socket.create_server(("127.0.0.1", 0))) as taken:
        where, other = (
            address(f"tcp://127.0.0.1:{port}", ("tcp",))
            for port in (mine[1], taken.getsockname()[1])
        )
        with pytest.raises(BadInput, match="cannot listen") as refused:
            Server(lambda: World((), 600), where, lambda *_: None, vehicles={1: other})
    socket.create_server(mine).close()
    assert refused, "its error still holds the server, so that nobody else has closed the port"
