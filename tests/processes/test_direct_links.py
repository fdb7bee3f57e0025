"""UxAS is killed in a flight in processes: by the direct link the vehicles keep apart, without it they meet."""

from __future__ import annotations

import math
import os
import signal
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.port import address
from cratous.bridge.tcp_port import TcpPort
from cratous.bridge.text_protocol.keys import DIRECT_VARIABLE, new_keys
from cratous.services.loading import load
from cratous.services.mission.frames import Projection
from cratous.services.processes import flight as flights
from cratous.services.processes.children import Children, free_port
from cratous.services.processes.coverage import told_of
from cratous.services.processes.direct_links import direct_links
from cratous.services.processes.files import (
    Ports,
    write_configuration,
    write_messages,
    write_scenario,
)
from cratous.spec.errors import BadInput

LIMIT_S = 600.0
KILLED_MS, END_MS, RATE = 8_000, 120_000, 6.0
"""On crossing they meet at 100 s, and ICAROUS would take over at 42 s."""


class Flight:
    """Simulator, UxAS and two ICAROUS with autopilots; UxAS is killed, and the others fly on."""

    def __init__(self, path: Path, folder: Path, children: Children, direct: bool) -> None:
        mission = load(path)
        self.children, self.plane = children, Projection(mission.frame)
        self.ids = ids = sorted(mission.instances)
        told = told_of(mission)
        scenario = write_scenario(mission, told, folder)
        write_messages(told, folder)
        ports = Ports(free_port(), free_port(), free_port())
        cfg = write_configuration(mission, ids, ports, folder)
        self.states: dict[int, dict[int, tuple[float, ...]]] = {}
        self.answered, self.commanded = False, set[int]()
        own = {vid: free_port() for vid in ids}
        of_vehicles = [x for vid in ids for x in ("--vehicle", f"{vid}=127.0.0.1:{own[vid]}")]
        children.start(
            "sim", "sim", str(scenario), "--listen", f"127.0.0.1:{ports.simulator}", "--clients", "1",
            *of_vehicles,
        )  # fmt: skip
        self.ports = list[TcpPort]()
        self.until(lambda: "listening" in children.said("sim"))
        self.connect(ports.simulator)
        self.until(lambda: self.states)
        self.control("Paused", 1.0)
        keys, between = new_keys(ids), new_keys(ids)
        unproved = "--allow-unproved"
        children.start("uxas", "uxas", "-cfgPath", str(cfg), unproved, private=keys.environment())
        self.connect(ports.recorder)
        self.until(lambda: self.ports[1].peers)
        group = f"239.255.77.3:{free_port()}"
        for vid in ids:
            private = keys.of(vid).environment()
            more = ("--direct", group) if direct else ()
            children.start(
                f"icarous_{vid}", "icarous", "--vehicle", str(vid), "--mission", str(path), "--connect",
                f"127.0.0.1:{ports.icarous}", "--autopilot", f"127.0.0.1:{own[vid]}", unproved, *more,
                private=private | between.environment(DIRECT_VARIABLE) if direct else private,
            )  # fmt: skip
        self.until(lambda: self.answered and self.commanded >= set(ids))
        self.control("Running", RATE)
        self.until(lambda: max(self.states) >= KILLED_MS)
        os.kill(children.running["uxas"].pid, signal.SIGKILL)
        self.until(lambda: max(self.states) >= END_MS)

    def connect(self, port: int) -> None:
        where = address(f"tcp://127.0.0.1:{port}", ("tcp",))
        self.ports.append(TcpPort(where, server=False))

    def control(self, state: str, rate: float) -> None:
        body = lmcp.new("SessionStatus", State=state, RealTimeMultiple=rate)
        self.ports[0].send((wire.enclose(body.all_names[0], lmcp.binary.pack(body)).pack(),))

    def until(self, done: Callable[[], object]) -> None:
        limit_s = time.monotonic() + LIMIT_S
        while not done():
            assert time.monotonic() < limit_s
            for port in self.ports:
                for incoming in port.step(time.monotonic()):
                    message = wire.parse(incoming.parts[0])
                    body = lmcp.binary.received(message.payload, message.descriptor)[0]
                    self.take(body, port is self.ports[0])
            time.sleep(0.002)

    def take(self, body: Any, simulated: bool) -> None:
        kind = type(body).__name__
        self.answered = self.answered or kind == "AutomationResponse"
        if simulated and kind == "MissionCommand":
            self.commanded.add(body.VehicleID)
        if simulated and kind == "AirVehicleState" and body.Time:
            place = self.plane.to_local(body.Location.Latitude, body.Location.Longitude)
            self.states.setdefault(body.Time, {})[body.ID] = (*place, body.Location.Altitude)

    def nearest_m(self) -> float:
        """At one altitude; the first states are told before the clock is the flight's."""
        both = [s for s in self.states.values() if set(s) == set(self.ids)]
        assert len(both) > END_MS / 1000
        one, other = self.ids
        return min(
            math.dist(s[one][:2], s[other][:2]) for s in both if abs(s[one][2] - s[other][2]) < 30
        )


@pytest.mark.long
@pytest.mark.parametrize("direct", [True, False])
def test_with_uxas_killed_only_the_direct_link_keeps_them_apart(
    root: Path, tmp_path: Path, direct: bool
) -> None:
    with Children(tmp_path, tmp_path) as children:
        path = root / "examples/crossing/mission.yaml"
        nearest_m = Flight(path, tmp_path, children, direct).nearest_m()
        said = [children.said(f"icarous_{vid}") for vid in (1, 2)]
    assert (nearest_m > 150.0) is direct
    assert any("UxAS does not tell it; avoided by its own word" in text for text in said) is direct
    assert all("no POSTN of UxAS; the state is the autopilot's" in text for text in said)


def test_without_direct_keys_a_direct_link_is_refused(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from cratous.services.cli import main

    words = ["icarous", "--vehicle", "1", "--mission", str(root / "examples/crossing/mission.yaml")]
    words += [
        "--connect",
        "127.0.0.1:1",
        "--plain",
        "--allow-unproved",
        "--log",
        str(tmp_path / "log"),
    ]
    assert main([*words, "--direct", "239.255.77.4:5600"]) == 2
    assert "no direct key" in capsys.readouterr().err
    for vid in (1, 2):
        (tmp_path / f"vehicle_{vid}.direct").write_text(f"{vid}{vid}" * 32)
    assert main([*words, "--keys", str(tmp_path), "--direct", "127.0.0.1:5600"]) == 2
    assert "no group" in capsys.readouterr().err


def test_a_flight_gives_each_icarous_the_group_and_all_direct_keys_and_uxas_none(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mission = load(root / "examples/crossing/mission.yaml")
    where = address(f"udp://239.255.77.5:{free_port()}", ("udp",))
    links = direct_links(where, mission.instances)
    started, had = dict[str, tuple[str, ...]](), dict[str, dict[str, str]]()
    how: Any = SimpleNamespace(
        tell=lambda _: None, folder=tmp_path, path=tmp_path, digest="0" * 64, rate=1.0,
        allow_unproved=True, original=False, amase=None, direct=links,
    )  # fmt: skip

    class Started:
        def start(self, name: str, *words: str, private: dict[str, str], **_: object) -> int:
            started[name], had[name] = words, private
            return 1

    nobody: Any = SimpleNamespace(accepted=id)
    plan: Any = SimpleNamespace(items=[])
    one = flights._Flight(mission, plan, nobody, nobody, how, Started())  # type: ignore[arg-type]
    monkeypatch.setattr(flights, "write_scenario", lambda *_: tmp_path)
    monkeypatch.setattr(flights, "write_messages", lambda *_: None)
    one._start_simulator = lambda _: 1  # type: ignore[method-assign]
    one._connect = lambda _: nobody  # type: ignore[method-assign]
    one._wait = one._control = lambda *_: None  # type: ignore[assignment,method-assign]
    one.start()
    direct = {DIRECT_VARIABLE.format(vid) for vid in mission.instances}
    assert set(started) == {"uxas", "icarous_1", "icarous_2"}
    for name, words in started.items():
        ours = name != "uxas"
        assert (("--direct", f"239.255.77.5:{where.port}") in pairwise(words)) is ours
        assert direct <= set(had[name]) if ours else not direct & set(had[name])
        assert not any(value in words for value in had[name].values()), "no key is an argument"
    assert had["icarous_1"].keys() - direct != had["icarous_2"].keys() - direct


@pytest.mark.parametrize(
    ("group", "vehicles", "what"),
    [
        ("239.255.77.6:5600", [1], "between vehicles"),
        ("239.255.77.6:5600", list(range(1, 30)), "between vehicles"),
        ("127.0.0.1:5600", [1, 2], "no group"),
    ],
)
def test_direct_links_that_cannot_be_are_refused_before_anything_starts(
    group: str, vehicles: list[int], what: str
) -> None:
    with pytest.raises(BadInput, match=what):
        direct_links(address(f"udp://{group}", ("udp",)), vehicles)


def test_direct_links_are_of_processes_alone(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from cratous.services.cli import main

    mission = str(root / "examples/crossing/mission.yaml")
    assert main(["run", mission, "--direct", "239.255.77.6:5600"]) == 2
    assert "--direct is of --processes" in capsys.readouterr().err
    words = ["--processes", "--original-clients", "--direct", "239.255.77.6:5600"]
    assert main(["run", mission, *words]) == 2
    assert "--direct is not of --original-clients" in capsys.readouterr().err
