"""The bridge between processes: `cratous uxas`, `cratous icarous`, and a stub simulator, over real sockets."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from bridge_flight import (
    TASK,
    WAY,
    Aircraft,
    Proxy,
    Simulator,
    command,
    configuration,
    icarous,
    listening,
    mission_file,
    said,
    way,
)
from uxas_tools import free_port

from cratous.bridge.link import LinkEvent
from cratous.bridge.port import Address
from cratous.bridge.text_port import TextPort
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.handshake import DEFAULT_SECRET, secret_of_environment
from cratous.services.certify.report import mission_hash
from cratous.services.cli import main
from cratous.services.cli.icarous import craft_of
from cratous.services.loading import load
from cratous.spec.errors import BadInput

SERVICE = "IcarousCommunicationService"  # named here for the table of services


def at(port: int) -> Address:
    return Address("tcp", "127.0.0.1", port, f"tcp://127.0.0.1:{port}")


def own() -> Aircraft:
    return Aircraft(1, -300.0, 0.0, 0.0)


@pytest.mark.slow
@pytest.mark.shows(
    SERVICE, "MissionCommand", "AirVehicleState", "VehicleActionCommand", "TaskPause", "TaskResume",
    "GateState", "AuthorityChange", "Heartbeat", "BridgeStatus", "NumberOfUAVs", "DeviationAllowed",
    "DeviationOrigin", "Address",
)  # fmt: skip
def test_takeover_avoidance_handback_and_the_mission_is_done(
    tmp_path: Path, opened: list[Any]
) -> None:
    more = 'NumberOfUAVs="1" DeviationAllowed="40" DeviationOrigin="path"'
    cfg, sim_port, ics_port = configuration(tmp_path, more)
    with (
        command(tmp_path, "uxas", "-cfgPath", str(cfg)) as uxas,
        icarous(tmp_path, ics_port) as pilot,
    ):
        sim = Simulator(sim_port, own(), Aircraft(90, 2000.0, 2300.0, 270.0))
        opened.append(sim)
        sim.client.send(way(*WAY), 1, 1)
        sim.own.told(way(*WAY))
        assert sim.fly(700, lambda: 4 in sim.own.passed), said(tmp_path)
        assert sim.nearest_m > 150.0
        owners = [change.Owner.name for change in sim.all("AuthorityChange")]
        assert owners == ["ICAROUS", "UxAS"]
        assert [p.TaskID for p in sim.all("TaskPause")] == [TASK]
        assert [r.TaskID for r in sim.all("TaskResume")] == [TASK]
        assert {1, 2, 3, 4} <= set(sim.own.passed)
        pilot.terminate()
        assert pilot.wait(120) == 0
        uxas.terminate()
        assert uxas.wait(120) == 0


def test_what_stands_on_the_wire_decides_and_a_cut_link_comes_again(
    tmp_path: Path, opened: list[Any]
) -> None:
    cfg, sim_port, ics_port = configuration(tmp_path, 'NumberOfUAVs="1"')
    proxy = Proxy(ics_port)
    opened.append(proxy)

    def far(line: bytes) -> bytes:
        return line.replace(b"OBJCT,type_TRAFFIC_,lat45.", b"OBJCT,type_TRAFFIC_,lat47.")

    def rubbish(line: bytes) -> bytes:
        return re.sub(rb"(POSTN.*),north[^,]*", rb"\1,north4000.000000", line)

    with (
        command(tmp_path, "uxas", "-cfgPath", str(cfg)),
        icarous(tmp_path, proxy.port),
    ):
        sim = Simulator(sim_port, own(), Aircraft(90, 2000.0, 2300.0, 270.0))
        opened.append(sim)
        sim.client.send(way(*WAY), 1, 1)
        sim.own.told(way(*WAY))
        # the intruder is told to be far away: with honest lines the takeover is at heartbeat 54
        proxy.change = far
        assert not sim.fly(75, lambda: sim.own.steered)
        proxy.change = lambda line: line
        assert sim.fly(12, lambda: sim.own.steered), said(tmp_path)
        # a cut while ICAROUS has the vehicle: it holds, and ICAROUS comes again
        proxy.cut()
        assert sim.wait(lambda: any("not heard" in text for text in reasons(sim)), 120.0)
        assert sim.wait(lambda: type(sim.own.flies).__name__ == "Circle", 120.0)
        again = "connected again"
        assert sim.wait(lambda: any(b.Note == again for b in sim.all("BridgeStatus")), 120.0)
        assert sim.fly(5, lambda: type(sim.own.flies).__name__ == "Fly"), said(tmp_path)
        # an own state that cannot be: ICAROUS says nothing any more, and the vehicle holds
        proxy.change = rubbish
        assert any(not sim.beat(3.0) for _ in range(4))  # answers of before may still come
        assert sim.wait(lambda: len(reasons(sim)) == 2, 120.0)
        assert sim.wait(lambda: type(sim.own.flies).__name__ == "Circle", 120.0)
    assert "POSTN that this airframe cannot fly" in said(tmp_path)


@pytest.mark.slow
@pytest.mark.shows(SERVICE, "Keys")
def test_v2_flies_with_the_key_and_refuses_another_on_both_ends(
    tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "keys").mkdir()
    (tmp_path / "keys" / "vehicle_1.key").write_text("5a" * 32)
    monkeypatch.setenv("CRATOUS_BRIDGE_KEY_1", "5b" * 32)
    more = f'NumberOfUAVs="1" VehicleIDs="1" Dialect="v2" Keys="{tmp_path / "keys"}"'
    cfg, sim_port, ics_port = configuration(tmp_path, more)
    with command(tmp_path, "uxas", "-cfgPath", str(cfg)):
        listening(tmp_path)
        with icarous(tmp_path, ics_port, "--v2", "--wait", "5", "--log", "wrong") as wrong:
            assert wrong.wait(120) == 3
        text = "the key of vehicle 1 is another one here"
        assert said(tmp_path).count(f"handshake failed: {text}") >= 1
        assert f"UxAS refuses: {text}" in said(tmp_path)
        with icarous(tmp_path, ics_port, "--v2", "--keys", str(tmp_path / "keys")):
            sim = Simulator(sim_port, own(), Aircraft(90, 2000.0, 2300.0, 270.0))
            opened.append(sim)
            sim.client.send(way(*WAY), 1, 1)
            sim.own.told(way(*WAY))
            assert sim.fly(100, lambda: sim.own.steered), said(tmp_path)
    assert "5a5a5a" not in said(tmp_path)
    assert "5b5b5b" not in said(tmp_path)


@pytest.mark.slow
@pytest.mark.shows(SERVICE, "Connect")
def test_uxas_connects_to_an_icarous_that_listens_and_again_after_a_cut(
    tmp_path: Path, opened: list[Any]
) -> None:
    listening = free_port()
    proxy = Proxy(listening)
    opened.append(proxy)
    cfg, sim_port, _ = configuration(tmp_path, 'NumberOfUAVs="1"', connect=proxy.port)
    with (
        command(tmp_path, "uxas", "-cfgPath", str(cfg)) as uxas,
        icarous(tmp_path, listening, end="--listen") as pilot,
    ):
        sim = Simulator(sim_port, own(), Aircraft(90, 2000.0, 2300.0, 270.0))
        opened.append(sim)
        sim.client.send(way(*WAY), 1, 1)
        sim.own.told(way(*WAY))
        assert sim.fly(100, lambda: sim.own.steered), said(tmp_path)
        # a second UxAS at the one that has one; only the end of the first makes room
        second = TextPort(at(listening), server=True, listens=False)
        opened.append(second)
        second.dial(0.0)
        ends = list[LinkEvent]()
        assert sim.wait(
            lambda: (
                ends.extend(c.what for c in second.step(0.0) if isinstance(c.what, LinkEvent)),
                ends,
            )[1],
            120.0,
        )
        proxy.cut()
        assert sim.wait(lambda: any("not heard" in text for text in reasons(sim)), 120.0)
        again = "connected again"
        assert sim.wait(lambda: any(b.Note == again for b in sim.all("BridgeStatus")), 120.0)
        assert sim.fly(700, lambda: 4 in sim.own.passed), said(tmp_path)
        assert sim.nearest_m > 150.0
        assert [c.Owner.name for c in sim.all("AuthorityChange")][-1] == "UxAS"
        for one in (pilot, uxas):
            one.terminate()
            assert one.wait(120) == 0
    assert "another UxAS is connected" in said(tmp_path)


CONNECT = ("--connect", "{where}")


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        ((*CONNECT, "--vehicle", "8"), 2, "the mission has no such vehicle"),
        (
            (*CONNECT, "--vehicle", "1", "--listen", "127.0.0.1:0"),
            2,
            "one of --connect and --listen",
        ),
        ((*CONNECT, "--vehicle", "1", "--connect", "nowhere"), 2, "not an address"),
        (
            (*CONNECT, "--vehicle", "1", "--wait", "0.3", "--plain"),
            3,
            "no UxAS for 0.3 s (Connection refused)",
        ),
        (("--vehicle", "1"), 2, "one of --connect and --listen is needed"),
        (
            (*CONNECT, "--vehicle", "1", "--wait", "0.3", "--mission-hash", "0" * 64),
            2,
            "another mission; expected " + "0" * 64,
        ),
        (("--vehicle", "1", "--listen", "192.0.2.1:9", "--plain"), 2, "no authentication"),
        (
            ("--vehicle", "1", "--listen", "127.0.0.1:0", "--thesis", "--keys", "."),
            2,
            "--keys is of --v2, and --thesis has none",
        ),
        (("--vehicle", "1", "--listen", "127.0.0.1:0"), 2, "no key of the bridge"),
        (("--vehicle", "1", "--listen", "127.0.0.1:0", "--v2"), 2, "no key of the bridge"),
        (
            ("--vehicle", "1", "--listen", "127.0.0.1:0", "--original"),
            2,
            "--original needs --connect",
        ),
        (
            ("--vehicle", "1", "--listen", "127.0.0.1:0", "--wait", "0.3", "--plain"),
            3,
            "no UxAS for 0.3 s (it has not connected)",
        ),
    ],
)
def test_the_command_says_what_is_wrong(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    arguments: tuple[str, ...],
    code: int,
    text: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    where = f"127.0.0.1:{free_port()}"
    words = [word.format(where=where) for word in arguments]
    assert main(["icarous", "--mission", str(mission_file(tmp_path)), *words]) == code
    assert text in capsys.readouterr().err


def test_the_mission_is_the_one_that_is_expected_and_says_how_it_is_flown(tmp_path: Path) -> None:
    path = mission_file(tmp_path)
    digest = mission_hash(load(path))
    assert (
        craft_of(path, 1, Dialect.CRATOUS, digest).step_s == 0.25
    )  # that of a mission that says none
    path.write_text(path.read_text() + "simulation: {step_ms: 1000, heartbeat_ms: 1000}\n")
    with pytest.raises(BadInput, match="another mission"):
        craft_of(path, 1, Dialect.CRATOUS, digest)
    craft = craft_of(path, 1, Dialect.CRATOUS)
    assert (craft.step_s, craft.config.heartbeat_ms) == (1.0, 1000)


@pytest.mark.parametrize("choice", ["finish", "loiter", "return", "land"])
def test_a_mission_that_has_vehicles_land_without_the_link_is_refused(
    tmp_path: Path, choice: str
) -> None:
    """All else is flown by UxAS's end, and changes nothing here."""
    path, more = mission_file(tmp_path), f"link_loss: {{choice: {choice}}}\n"
    plain = craft_of(path, 1, Dialect.CRATOUS)
    if choice == "land":
        place = "{north_m: 300, east_m: 1500}"
        more += f"landing_sites: [{{name: field, position: {place}, radius_m: 200}}]\n"
    path.write_text(path.read_text() + more)
    if choice != "land":
        craft = craft_of(path, 1, Dialect.CRATOUS)
        assert craft.config.lost_link is None
        assert (craft.floor_m, craft.cooperating) == (plain.floor_m, plain.cooperating)
        return
    with pytest.raises(BadInput) as caught:
        craft_of(path, 1, Dialect.CRATOUS)
    assert caught.value.item == "link_loss.choice"
    assert caught.value.got == "land"


def test_the_secret_of_the_environment_is_checked_and_not_shown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert secret_of_environment() == DEFAULT_SECRET
    monkeypatch.setenv("CRATOUS_BRIDGE_SECRET", "a" * 64)
    assert secret_of_environment() == "a" * 64
    monkeypatch.setenv("CRATOUS_BRIDGE_SECRET", "hunter2")
    with pytest.raises(BadInput, match="got 7 characters") as wrong:
        secret_of_environment()
    assert "hunter2" not in str(wrong.value)


def reasons(sim: Simulator) -> list[str]:
    """What ServiceStatuses of errors say."""
    bodies = [b for b in sim.all("ServiceStatus") if b.StatusType.name == "Error"]
    return [pair.Value for body in bodies for pair in body.Info if pair.Key == "reason"]
