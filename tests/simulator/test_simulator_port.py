"""The simulator's port: what clients get and may do; UxAS flies its waterway mission on it."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import pytest
from simulator_tools import GO_TO, mission, ordered, scenario, waypoint
from uxas_tools import LIMIT_S, Client, ended, started

from cratous.bridge import lmcp
from cratous.bridge.port import address
from cratous.services.cli import main
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.server import ClientGone, Server
from cratous.services.simulator.world import World

FLIGHT = mission(waypoint(1, 2, 45.02), waypoint(2, 2, 45.1))


@contextlib.contextmanager
def simulating(
    path: Path, *options: str, errors: IO[str] | None = None
) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """`cratous sim` as a process of its own, and its port."""
    running = subprocess.Popen(
        [sys.executable, "-m", "cratous", "sim", str(path), "--listen", "127.0.0.1:0", *options],
        stdout=subprocess.PIPE,
        stderr=errors,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )
    with ended(running):
        assert running.stdout is not None
        found = re.search(r"listening on 127\.0\.0\.1:(\d+)", running.stdout.readline())
        assert found
        yield running, int(found[1])


@pytest.fixture
def here() -> Iterator[tuple[Server, list[str], list[Client]]]:
    """A server in this thread that `turn` drives, and two clients."""
    said: list[str] = []
    plan = of_text(scenario(FLIGHT), "test")
    where = address("tcp://127.0.0.1:0", ("tcp",), free=True)
    server = Server(
        lambda: World(plan.events, 600), where, lambda _severity, text: said.append(text), clients=2
    )
    clients = [Client(server.port.bound[1]) for _ in range(2)]
    yield server, said, clients
    for client in clients:
        client.close()
    server.port.close()


def turn(server: Server, seconds: float) -> None:
    """Let time pass for a server."""
    for _ in range(int(seconds * 10)):
        server.turn(time.monotonic(), 0.1)


def last(client: Client, kind: str) -> Any:
    client.read()
    found = [m for m in client.got if m.descriptor.endswith("." + kind)]
    return lmcp.binary.unpack(found[-1].payload)


def test_clients_see_and_command_a_vehicle(here: Any) -> None:
    server, said, (one, two) = here
    turn(server, 5)
    assert {"AirVehicleConfiguration", "AirVehicleState", "SessionStatus", "MissionCommand"} <= set(
        one.kinds()
    )
    assert one.got[0].attributes[3:] == ("0", "0"), "as AMASE names itself"
    before = one.kinds().count("VehicleActionCommand")
    one.send(of_text(scenario(ordered(0, GO_TO.format(2))), "x").events[-1].body)
    turn(server, 5)
    assert last(two, "AirVehicleState").CurrentWaypoint == 2
    assert two.kinds().count("VehicleActionCommand") == 1, "relayed to the others"
    assert one.kinds().count("VehicleActionCommand") == before, "not to the sender"
    assert all("has connected" in text for text in said), "nothing is refused"


def test_a_client_pauses_hastens_and_resets(here: Any) -> None:
    server, said, (one, two) = here
    turn(server, 5)
    assert server.world.time_s == pytest.approx(5, abs=0.2)
    one.send(lmcp.new("SessionStatus", State="Paused"))
    turn(server, 1)
    stood = server.world.time_s
    turn(server, 3)
    assert server.world.time_s == stood
    assert last(two, "SessionStatus").State.name == "Paused"
    one.send(lmcp.new("SessionStatus", State="Running", RealTimeMultiple=3.0))
    turn(server, 0.2)
    turn(server, 4)
    assert server.world.time_s - stood == pytest.approx(12.6, abs=1)
    one.send(lmcp.new("SessionStatus", State="Reset"))
    turn(server, 0.5)
    assert server.world.time_s == 0
    assert any("Reset" in text for text in said)


def test_what_cannot_be_taken_is_said_and_changes_nothing(here: Any) -> None:
    server, said, (one, two) = here
    turn(server, 3)
    one.raw(b"+=+=+=+=99999999999#@#@#@#@rubbish")
    one.send(lmcp.new("MissionCommand", VehicleID=9, CommandID=5))
    bad = of_text(scenario(FLIGHT), "x").events[-1].body
    bad = bad.copy(WaypointList=[bad.WaypointList[0].copy(Latitude=float("nan"))])
    one.send(bad)
    turn(server, 3)
    assert any("vehicle that is not there" in text for text in said)
    assert two.kinds().count("MissionCommand") == 1, "that of the scenario"
    assert last(two, "AirVehicleState").CurrentWaypoint == 1
    assert server.refused["message"] == 2


def test_of_only_two_clients_nobody_takes_the_place() -> None:
    plan = of_text(scenario(FLIGHT), "test")
    where = address("tcp://127.0.0.1:0", ("tcp",), free=True)
    server = Server(lambda: World(plan.events, 600), where, lambda *_: None, only=2)
    port = server.port.bound[1]
    with contextlib.closing(server.port), contextlib.ExitStack() as open_ones:
        clients = [Client(port) for _ in range(2)]
        for client in clients:
            open_ones.callback(client.close)
        turn(server, 1)
        assert {"AirVehicleState"} <= set(clients[0].kinds()) & set(clients[1].kinds())
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", port), 5)
        clients[1].close()
        with pytest.raises(ClientGone, match="1 of the 2 clients"):
            turn(server, 1)
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", port), 5)


def test_of_those_that_come_at_once_only_so_many_are_let_in() -> None:
    plan = of_text(scenario(FLIGHT), "test")
    where = address("tcp://127.0.0.1:0", ("tcp",), free=True)
    server = Server(lambda: World(plan.events, 600), where, lambda *_: None, only=1)
    with contextlib.closing(server.port), contextlib.ExitStack() as open_ones:
        clients = [Client(server.port.bound[1]) for _ in range(2)]
        for client in clients:
            open_ones.callback(client.close)
        turn(server, 1)
        assert "AirVehicleState" in clients[0].kinds()
        with contextlib.suppress(ConnectionResetError):
            assert clients[1].kinds() == []
            assert clients[1].ended


def test_an_only_client_that_asks_to_end_and_goes_ends_it_in_order() -> None:
    plan = of_text(scenario(FLIGHT), "test")
    where = address("tcp://127.0.0.1:0", ("tcp",), free=True)
    server = Server(lambda: World(plan.events, 600), where, lambda *_: None, only=1)
    client = Client(server.port.bound[1])
    turn(server, 1)
    client.send(lmcp.new("SessionStatus", State="Stopped"))
    client.close()
    server.run()
    assert server.state == "Stopped"


@pytest.mark.parametrize(
    ("options", "item"),
    [
        (["--only", "2"], "--clients, --only"),
        (["--clients", "2"], "--clients, --only"),
        (["--listen", "127.0.0.1:0", "--only", "1", "--clients", "2"], "--clients"),
    ],
)
def test_clients_that_cannot_be_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], item: str
) -> None:
    path = tmp_path / "s.xml"
    path.write_text(scenario(FLIGHT))
    assert main(["sim", str(path), *options]) == 2
    assert item in capsys.readouterr().err


def test_a_client_that_does_not_read_holds_up_nobody(tmp_path: Path) -> None:
    path = tmp_path / "s.xml"
    path.write_text(scenario(FLIGHT).replace(">600<", ">7200<"))
    with simulating(path, "--rate", "2000", "--clients", "2") as (running, port):
        sleeper = socket.create_connection(("127.0.0.1", port))
        client = Client(port)
        states = 0
        end = time.monotonic() + LIMIT_S
        while running.poll() is None and time.monotonic() < end:
            with contextlib.suppress(OSError):
                client.read()
            time.sleep(0.01)
        assert running.wait(LIMIT_S) == 0
        states = client.kinds().count("AirVehicleState")
        sleeper.close()
        client.close()
    assert states > 13_000, "all of two hours"


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_it_ends_when_it_is_asked_to(tmp_path: Path, number: int) -> None:
    path = tmp_path / "s.xml"
    path.write_text(scenario(FLIGHT))
    with simulating(path) as (running, port):
        client = Client(port, running)
        client.wait("AirVehicleState")
        running.send_signal(number)
        assert running.wait(LIMIT_S) == 0
        client.close()


def test_what_changes_nothing_is_told_at_the_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    zone = '<KeyValuePair Series="CMASI" Time="2"><Key>a</Key></KeyValuePair>'
    path = tmp_path / "s.xml"
    path.write_text(scenario(FLIGHT, zone))
    assert main(["sim", str(path), "--until", "5"]) == 0
    assert "1 x KeyValuePair changes nothing" in capsys.readouterr().err
    with (tmp_path / "err").open("w+") as errors:
        with simulating(path, errors=errors) as (running, port):
            client = Client(port, running)
            client.wait("KeyValuePair")
            client.send(lmcp.new("KeyValuePair", Key="b"))
            client.send(lmcp.new("SessionStatus", State="Stopped"))
            assert running.wait(LIMIT_S) == 0
            client.close()
        errors.seek(0)
        assert "2 x KeyValuePair changes nothing" in errors.read()


def test_the_command_says_where_a_scenario_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "s.xml"
    path.write_text(scenario(FLIGHT).replace("<Speed>22</Speed>", "<Speed>fast</Speed>"))
    assert main(["sim", str(path)]) == 2
    assert re.search(r"s\.xml:\d+.*Speed.*fast", capsys.readouterr().err)
    path.write_text(scenario(FLIGHT))
    one, two = tmp_path / "one", tmp_path / "two"
    for output in (one, two):
        assert main(["sim", str(path), "--until", "60", "-o", str(output)]) == 0
    assert one.read_bytes() == two.read_bytes()
    assert one.stat().st_size > 10_000
    assert "60 s of 1 aircraft" in capsys.readouterr().out


@pytest.mark.slow
def test_uxas_flies_its_waterway_mission_on_the_simulator(shared: Path, tmp_path: Path) -> None:
    """The example's own configuration and files; vehicles, states and flight are the simulator's."""
    text = (shared / "vectors/amase/scenarios/02_waterway.xml").read_text()
    text = re.sub(r"<MissionCommand .*?</MissionCommand>", "", text, flags=re.DOTALL)
    text = re.sub(r"<ScenarioDuration>[^<]*<", "<ScenarioDuration>3600<", text)
    path = tmp_path / "waterway.xml"
    path.write_text(text)
    folder = shared / "examples/openuxas/waterway"
    with simulating(path, "--rate", "80", "--clients", "2") as (running, port):
        cfg = (folder / "cfg_run.xml").read_text()
        cfg = cfg.replace("../MessagesToSend/", f"{(folder / 'inputs').resolve()}/")
        cfg = re.sub(r'<Message MessageFileName="AirVehicle.*?/>', "", cfg)
        cfg = re.sub(r"<Bridge .*?</Bridge>", "", cfg, flags=re.DOTALL)
        bridge = f"""<Bridge Type="LmcpObjectNetworkTcpBridge" TcpAddress="tcp://127.0.0.1:{port}"
Server="FALSE"><SubscribeToMessage MessageType="afrl.cmasi.MissionCommand"/>
<SubscribeToMessage MessageType="afrl.cmasi.VehicleActionCommand"/>
<SubscribeToMessage MessageType="afrl.cmasi.AutomationResponse"/></Bridge></UxAS>"""
        (tmp_path / "cfg.xml").write_text(cfg.replace("</UxAS>", bridge))
        with started(
            tmp_path / "cfg.xml", "-runUntil", "600", "--without", "MessageLoggerDataService"
        ):
            client = Client(port)
            (command,) = client.wait("AutomationResponse").MissionCommandList
            assert command.VehicleID == 400
            assert len(command.WaypointList) > 50
            left = {w.Number: w for w in command.WaypointList}
            final, seen, end = command.WaypointList[-1], 0, time.monotonic() + 5 * LIMIT_S
            while final.Number in left and time.monotonic() < end:
                client.read()
                for message in client.got[seen:]:
                    if message.descriptor == "afrl.cmasi.AirVehicleState":
                        _pass(left, lmcp.binary.unpack(message.payload))
                seen = len(client.got)
                time.sleep(0.05)
            assert client.kinds().count("MissionCommand") >= 4, "in segments"
            client.send(lmcp.new("SessionStatus", State="Stopped"))
            assert running.wait(LIMIT_S) == 0
            client.close()
    assert not left, f"waypoints not flown: {sorted(left)}"


def _pass(left: dict[int, Any], state: Any) -> None:
    """Waypoints within 150 m of vehicle 400 are no longer left."""
    if state.ID != 400:
        return
    place = state.Location
    for number, w in list(left.items()):
        north, east = (
            (w.Latitude - place.Latitude) * 111_200,
            (w.Longitude - place.Longitude) * 79_000,
        )
        if north * north + east * east < 150**2:
            del left[number]
