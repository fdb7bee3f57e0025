"""AMASE in place of our simulator: it is given the mission's aircraft, told what it does otherwise, and met again."""

from __future__ import annotations

import contextlib
import itertools
import json
import math
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from amase_tools import PATIENCE_S, Fake, Session, Way, until
from simulator_tools import scenario
from uxas_tools import ended

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.port import Incoming, address
from cratous.bridge.tcp_port import TcpPort
from cratous.services.cli import main
from cratous.services.loading import load
from cratous.services.mission.frames import Projection
from cratous.services.processes import amase as amase_module
from cratous.services.processes.amase import AmaseLost, amase_address
from cratous.services.processes.children import free_port
from cratous.services.processes.coverage import refuse_for_amase, told_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Position, Traffic, Velocity

EMPTY = """<AMASE><ScenarioData><ScenarioName>empty</ScenarioName><ScenarioDuration>3600</ScenarioDuration>
</ScenarioData><ScenarioEventList></ScenarioEventList></AMASE>"""


@pytest.fixture
def crossing(root: Path) -> Mission:
    return load(root / "examples/crossing/mission.yaml", 0)


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """AMASE may be away for half a second."""
    monkeypatch.setattr(amase_module, "RETURNS_S", 0.5)


@pytest.fixture
def fake(tmp_path: Path) -> Iterator[Callable[..., Fake]]:
    made: list[Fake] = []

    def make(text: str = EMPTY, rate: int = 4) -> Fake:
        made.append(Fake(tmp_path, text, rate))
        made[-1].start()
        return made[-1]

    yield make
    for one in made:
        one.end()


@pytest.fixture
def session() -> Iterator[Callable[[Fake | Way], Session]]:
    made: list[Session] = []

    def make(fake: Fake | Way) -> Session:
        made.append(Session(fake.port))
        made[-1].until(lambda: made[-1].uxas.peers)
        return made[-1]

    yield make
    for one in made:
        one.close()


def apart_m(mission: Mission, state: Any, north_m: float, east_m: float) -> float:
    north, east = Projection(mission.frame).to_local(
        state.Location.Latitude, state.Location.Longitude
    )
    return math.hypot(north - north_m, east - east_m)


def _flies_on(mission: Mission, before: dict[int, Any], states: list[Any]) -> None:
    """Each aircraft is found on straight from its last state, within one period of states."""
    for number, last in before.items():
        again = next(body for body in states if number == body.ID)
        north, east = Projection(mission.frame).to_local(
            last.Location.Latitude, last.Location.Longitude
        )
        passed_s = (again.Time - last.Time) / 1000
        assert 0 < passed_s < 0.6
        assert apart_m(mission, again, north, east) == pytest.approx(22 * passed_s, abs=0.5)


def steered(vehicle: int, *actions: Any) -> Any:
    return lmcp.new(
        "VehicleActionCommand", CommandID=7, VehicleID=vehicle, VehicleActionList=[*actions]
    )


def test_aircraft_are_put_in_whatever_has_been_loaded_and_the_time_is_that_of_the_flight(
    crossing: Mission, fake: Callable[..., Fake], session: Callable[[Fake], Session]
) -> None:
    """The scenario has an aircraft 1 elsewhere, which flies for a while; what was commanded before holds."""
    flight = session(fake(scenario()))
    flight.command(steered(1, lmcp.new("FlightDirectorAction", Speed=22, Heading=90, Altitude=300)))
    end_s = time.monotonic() + 0.5
    flight.until(lambda: time.monotonic() > end_s)
    assert not flight.states + flight.passed_on, "nothing counts before the flight begins"
    flight.amase.begin(crossing, told_of(crossing))
    flight.until(lambda: len(flight.states) >= 8)
    first = {body.ID: body for body in flight.states[:2]}
    assert first.keys() == {1, 2}
    for vehicle in crossing.vehicles:
        place = vehicle.position
        # no more than the time between two states at its speed
        assert apart_m(crossing, first[vehicle.id], place.north_m, place.east_m) < 0.6 * 22
        assert first[vehicle.id].Time == 500
    assert flight.newest(1).Course > 20 > first[1].Course
    flight.until(lambda: len(flight.passed_on) >= 8)
    assert [b.Time for b in flight.passed_on[:8]] == [b.Time for b in flight.states[:8]]


def test_one_that_is_killed_and_begun_again_flies_on_from_its_last_states(
    crossing: Mission, fake: Callable[..., Fake], session: Callable[[Fake], Session]
) -> None:
    simulator = fake()
    flight = session(simulator)
    flight.amase.begin(crossing, told_of(crossing))
    flight.until(lambda: flight.amase.flies)
    flight.command(steered(1, lmcp.new("FlightDirectorAction", Speed=22, Heading=90, Altitude=300)))
    flight.until(lambda: flight.newest(1).Course > 20)
    simulator.kill()
    flight.until(lambda: not flight.amase.flies)
    count, before = len(flight.states), {n: flight.newest(n) for n in (1, 2)}
    assert "its connection has ended" in flight.said[0]
    # what UxAS says meanwhile is not lost
    flight.command(steered(2, lmcp.new("FlightDirectorAction", Speed=22, Heading=0, Altitude=300)))
    end_s = time.monotonic() + 0.2
    flight.until(lambda: time.monotonic() > end_s)
    assert len(flight.states) == count
    simulator.start()
    flight.until(lambda: flight.amase.flies)
    _flies_on(crossing, before, flight.states[count:])
    flight.until(lambda: flight.newest(1).Course > 80 and flight.newest(2).Course < 70)
    times = [body.Time for body in flight.states if body.ID == 1]
    assert times == sorted(set(times))
    assert len(flight.amase.met_again) == 1
    assert "flies again" in flight.said[-1]


def test_one_that_stands_still_is_lost_in_time_and_flies_on_when_it_goes_on(
    crossing: Mission,
    fake: Callable[..., Fake],
    session: Callable[[Fake], Session],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its connection stands, and it can be connected to; so it answers no sooner than it says something."""
    simulator = fake()
    flight = session(simulator)
    flight.amase.begin(crossing, told_of(crossing))
    flight.until(lambda: flight.amase.flies)
    flight.command(steered(1, lmcp.new("FlightDirectorAction", Speed=22, Heading=90, Altitude=300)))
    flight.until(lambda: flight.newest(1).Course > 20)
    simulator.signal(signal.SIGSTOP)
    # not before, nor when it goes on: a loaded machine is silent for a second too
    monkeypatch.setattr(amase_module, "SILENT_S", 1.5)
    flight.until(lambda: not flight.amase.flies)
    assert 1.0 < time.monotonic() - flight.heard_s < 1.5 + PATIENCE_S / 8
    assert "it has not told states of all aircraft of the mission for 1.5 s" in flight.said[0]
    count, before = len(flight.states), flight.newest(1)
    end_s = time.monotonic() + 4.0
    flight.until(lambda: time.monotonic() > end_s)
    assert len(flight.said) == 1
    monkeypatch.setattr(amase_module, "SILENT_S", 60.0)
    simulator.signal(signal.SIGCONT)
    flight.until(lambda: flight.amase.flies)
    assert 0 < next(b for b in flight.states[count:] if b.ID == 1).Time - before.Time < 600
    flight.until(lambda: flight.newest(1).Course > 80)
    assert [re.sub(r".*:\d+ ", "", one).split(",")[0] for one in flight.said[1:]] == [
        "answers again", "flies again",
    ]  # fmt: skip
    assert len(flight.amase.met_again) == 1


def test_a_way_to_it_that_is_gone_unsaid_is_another_one_soon(
    crossing: Mission,
    fake: Callable[..., Fake],
    session: Callable[[Fake | Way], Session],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Neither end of the connection ends: it flies on there, and is flown again from the last states that came."""
    way = Way(fake().port)
    with contextlib.closing(way):
        flight = session(way)
        flight.amase.begin(crossing, told_of(crossing))
        flight.until(lambda: flight.amase.flies and flight.states[-1].Time > 3000)
        way.cut()
        # not before, nor on the new way: a loaded machine is silent for a second too
        monkeypatch.setattr(amase_module, "SILENT_S", 1.5)
        flight.until(lambda: not flight.amase.flies)
        monkeypatch.setattr(amase_module, "SILENT_S", 60.0)
        count, before = len(flight.states), {n: flight.newest(n) for n in (1, 2)}
        flight.until(lambda: flight.amase.flies)
        assert way.met == 2
        _flies_on(crossing, before, flight.states[count:])
        assert len(flight.amase.met_again) == 1
        flight.close()


def test_a_clock_that_goes_back_is_a_simulator_begun_anew(
    crossing: Mission, fake: Callable[..., Fake], session: Callable[[Fake], Session]
) -> None:
    simulator = fake()
    flight = session(simulator)
    flight.amase.begin(crossing, told_of(crossing))
    flight.until(lambda: flight.states and flight.states[-1].Time > 3000)
    other = TcpPort(address(f"tcp://127.0.0.1:{simulator.port}", ("tcp",)), server=False)
    for state in ("Reset", "Running"):
        body = lmcp.new("SessionStatus", State=state, RealTimeMultiple=4.0)
        until(lambda: other.step(time.monotonic()) or other.peers)
        other.send((wire.enclose(body.all_names[0], lmcp.binary.pack(body)).pack(),))
    flight.until(lambda: flight.amase.met_again and flight.states[-1].Time > 5000)
    other.close()
    assert "its clock has gone back" in flight.amase.met_again[0]
    times = [body.Time for body in flight.states if body.ID == 1]
    assert times == sorted(set(times))
    assert max(b - a for a, b in itertools.pairwise(times)) < 600


def test_one_that_does_not_come_back_ends_the_flight(
    crossing: Mission,
    fake: Callable[..., Fake],
    session: Callable[[Fake], Session],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    simulator = fake()
    flight = session(simulator)
    flight.amase.begin(crossing, told_of(crossing))
    flight.until(lambda: flight.amase.flies)
    monkeypatch.setattr(amase_module, "RETURNS_S", 0.5)  # not before: it may have been slow to fly
    simulator.kill()
    with pytest.raises(
        AmaseLost, match=r"amase://127\.0\.0\.1:\d+ has not been met again for 0.5 s"
    ) as lost:
        flight.until(lambda: False)
    assert lost.value.exit_code == 3


def test_what_another_client_says_is_not_read(
    crossing: Mission, fake: Callable[..., Fake], session: Callable[[Fake], Session]
) -> None:
    """AMASE passes on what it is sent: of a series that is not known here, or a command."""
    flight = session(fake())
    flight.amase.begin(crossing, told_of(crossing))
    flight.until(lambda: flight.amase.flies)
    for name in ("larcfm.DAIDALUS.WellClearViolationIntervals", "afrl.cmasi.MissionCommand"):
        payload = wire.enclose(name, b"LMCP" + bytes(20)).pack()
        assert flight.amase._from_amase(Incoming((payload,), "amase")) == []
    count = len(flight.states)
    flight.until(lambda: len(flight.states) > count)


@pytest.mark.usefixtures("impatient")
def test_one_whose_clock_does_not_run_is_said_to_stand(
    crossing: Mission, fake: Callable[..., Fake], session: Callable[[Fake], Session]
) -> None:
    simulator = fake()
    simulator.kill()
    simulator.start(clients=2)
    flight = session(simulator)
    flight.amase.begin(crossing, told_of(crossing))
    with pytest.raises(AmaseLost, match=r"has told no time: its clock has not run for 0.5 s"):
        flight.until(lambda: False)


def test_an_aircraft_that_the_mission_has_not_is_refused(
    crossing: Mission, fake: Callable[..., Fake], session: Callable[[Fake], Session]
) -> None:
    flight = session(fake(scenario().replace("<ID>1</ID>", "<ID>9</ID>")))
    flight.amase.begin(crossing, told_of(crossing))
    with pytest.raises(AmaseLost, match="an aircraft 9, which the mission has not"):
        flight.until(lambda: False)


# what is refused --------------------------------------------------------------------------------------------


def test_what_amase_cannot_fly_is_refused_by_its_field(crossing: Mission) -> None:
    refuse_for_amase(crossing)
    one = Traffic(9, Position(0, 0, 300), Velocity(20, 0, 0), appears_ms=5000)
    with pytest.raises(BadInput, match=r"traffic\[0\]: traffic that comes or goes in flight"):
        refuse_for_amase(replace(crossing, traffic=(one,)))
    hovers = replace(crossing.vehicles[1], min_speed_m_s=0.0)
    with pytest.raises(BadInput, match=r"vehicles\[1\]\.min_speed_m_s: an aircraft that can hover"):
        refuse_for_amase(replace(crossing, vehicles=(crossing.vehicles[0], hovers)))


@pytest.mark.parametrize(
    "text", ["tcp://127.0.0.1:5555", "amase://127.0.0.1", "amase://h:0", "5555"]
)
def test_an_address_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(BadInput, match="expected amase://HOST:PORT"):
        amase_address(text)


def test_nobody_there_is_bad_input_before_anything_is_planned(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(amase_module, "ANSWERS_S", 0.2)
    mission, out = str(root / "examples/crossing/mission.yaml"), str(tmp_path / "out")
    where = f"amase://127.0.0.1:{free_port()}"
    assert main(["run", mission, "--simulator", where, "--out", out]) == 2
    said = capsys.readouterr()
    assert f"{where}: --simulator: no answer at this address" in said.err
    assert "plan:" not in said.out + said.err
    assert main(["run", mission, "--simulator", where, "--rate", "2", "--out", out]) == 2
    assert "AMASE's clock runs at its own rate" in capsys.readouterr().err


@pytest.mark.slow
def test_a_mission_is_flown_to_its_end_though_amase_is_begun_anew(
    root: Path, tmp_path: Path, fake: Callable[..., Fake]
) -> None:
    simulator = fake(rate=4)
    said, out = tmp_path / "said", tmp_path / "out"
    words = [
        sys.executable, "-m", "cratous", "run", str(root / "examples/crossing/mission.yaml"), "--simulator",
        f"amase://127.0.0.1:{simulator.port}", "--out", str(out), "--allow-unproved",
    ]  # fmt: skip
    with said.open("w") as stream:
        running = subprocess.Popen(words, stdout=stream, stderr=subprocess.STDOUT)
        with ended(running):
            end_s = time.monotonic() + 600
            while not re.search(r"\b(?:[6-9]\d|1[0-2]\d)\.\d s of flight", said.read_text()):
                assert running.poll() is None, said.read_text()
                assert time.monotonic() < end_s
                time.sleep(0.05)
            simulator.kill()
            simulator.start()
            code = running.wait(600)
    report = json.loads((out / "crossing/report.json").read_text())
    # heartbeats may be late, and nothing holds of theorems about a gate on board
    assert code == report["exit_code"]
    assert code in (1, 3), said.read_text()
    assert report["flight"]["outcome"] == "complete"
    assert report["flight"]["takeovers"]
    verdicts = {row["requirement"]: row["verdict"] for row in report["requirements"]}
    assert [verdicts[g] for g in ("G1", "G2", "G3")] == ["holds"] * 3, said.read_text()
    notes = " ".join(report["mission"]["notes"])
    assert f"the aircraft flew in AMASE at 127.0.0.1:{simulator.port}" in notes
    assert "AMASE was lost and met again at " in notes
    assert main(["judge", str(out / "crossing")]) in (0, 1)
