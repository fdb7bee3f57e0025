"""What is noticed of the processes in flight: ends while much is said, ends just before the end, ends of connections."""

from __future__ import annotations

import subprocess
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.bridge.port import Incoming
from cratous.services.loading import load
from cratous.services.processes import flight as flights
from cratous.services.processes.children import Children, ProcessEnded
from cratous.services.processes.failing_bridge import FailingBridge
from cratous.services.processes.flight import Stuck
from cratous.services.simulator.server import frame_payload
from cratous.spec.mission import FaultySimulation
from cratous.spec.mission.bridge_faults import BridgeFaults

STATE = Incoming((frame_payload(lmcp.new("AirVehicleState", ID=1)),), "the simulator")


class Port:
    """A connection over which something has always just come."""

    def __init__(self, *incoming: Incoming) -> None:
        self.peers, self._incoming = 1, incoming

    def step(self, _now_s: float) -> tuple[Incoming, ...]:
        return self._incoming


class Processes:
    """Processes of which one may have ended."""

    def __init__(self, ended: bool) -> None:
        self._ended, self.running = ended, dict[str, Any]()

    def watch(self) -> None:
        if self._ended:
            raise ProcessEnded("icarous_1", 1, ())


class Recorder:
    """Keeps how the log ends."""

    now_ms, ends = 0, ""

    def failed(self, task: int, *_: Any) -> None:
        raise AssertionError(f"task {task} has not failed")

    def end(self, outcome: str) -> None:
        self.ends = outcome or "cut off"


def flight(root: Path, ended: bool) -> Any:
    mission = load(root / "examples/crossing/mission.yaml", 0)
    plan: Any = SimpleNamespace(items=[SimpleNamespace(task_id=k, vehicle_id=k) for k in (1, 2)])
    how: Any = SimpleNamespace(tell=lambda _text: None, original=False, amase=None)
    told: Any = None
    recorder, processes = Recorder(), Processes(ended)
    return flights._Flight(mission, plan, told, recorder, how, processes)  # type: ignore[arg-type]


def test_a_process_that_ends_is_noticed_however_much_the_others_say(root: Path) -> None:
    one = flight(root, ended=True)
    one.simulator = Port(STATE)
    with pytest.raises(ProcessEnded):
        one._turn()


@pytest.mark.parametrize(("ended", "outcome"), [(True, ""), (False, "complete")])
def test_a_flight_of_which_a_process_ends_with_the_last_task_is_not_whole(
    root: Path, ended: bool, outcome: str
) -> None:
    one = flight(root, ended)
    one._turn = lambda: one.ending.complete.update((1, 2))
    done = one.run()
    assert (done.outcome, bool(done.why)) == (outcome, ended)
    assert one.recorder.ends == (outcome or "cut off")


@pytest.mark.parametrize("silent", [flights.SIMULATOR, flights.UXAS])
def test_one_that_runs_and_says_nothing_ends_the_flight(
    root: Path, monkeypatch: pytest.MonkeyPatch, silent: str
) -> None:
    now_s = iter(range(10_000))
    clock = SimpleNamespace(monotonic=lambda: float(next(now_s)))
    monkeypatch.setattr(flights, "time", clock)
    one = flight(root, ended=False)
    (talks,) = {flights.SIMULATOR, flights.UXAS} - {silent}
    one._turn = lambda: one.news_s.update({talks: float(next(now_s))})
    done = one.run()
    assert (done.outcome, done.why) == ("", f"{silent} has told nothing of the flight for 60 s")


def test_uxas_may_be_silent_while_it_hears_no_icarous(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It reports the heartbeats of ICAROUS; the flight ends at its limit, or in the safe state."""
    now_s = iter(range(10_000))
    clock = SimpleNamespace(monotonic=lambda: float(next(now_s)))
    monkeypatch.setattr(flights, "time", clock)
    one, turns = flight(root, ended=False), iter(range(1000))
    one.ending.unheard |= set(one.mission.instances)

    def turn() -> None:
        one.news_s[flights.SIMULATOR] = float(next(now_s))
        if next(turns) == 100:
            one.ending.unheard.pop()

    one._turn = turn
    done = one.run()
    assert next(turns) > 105, "only since one is heard"
    assert done.why == "uxas has told nothing of the flight for 60 s"


def test_whoever_tells_something_of_the_flight_is_not_silent(root: Path) -> None:
    one = flight(root, ended=False)
    one.recorder = SimpleNamespace(heard=id, state=id)
    one.flown = True
    one._from_uxas(lmcp.new("TaskActive", TaskID=1))
    assert list(one.news_s) == [flights.UXAS]
    one._from_simulator(lmcp.new("AirVehicleState", ID=1, Time=500))
    assert list(one.news_s) == [flights.UXAS, flights.SIMULATOR]


def test_what_cannot_be_read_names_who_says_it(root: Path) -> None:
    one = flight(root, ended=False)
    one.uxas = Port(Incoming((b"rubbish",), "UxAS"))
    with pytest.raises(Stuck, match="what uxas says cannot be read"):
        one._turn()


def test_a_connection_that_ends_before_the_flight_is_noticed_at_once(
    root: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(flights, "GRACE_S", 0.0)
    one = flight(root, ended=False)
    one.uxas = port = Port()
    one._turn()
    port.peers = 0
    with pytest.raises(Stuck, match="recorder to uxas has ended"):
        one._turn()


def test_icarous_stands_still_while_it_is_to_be_silent_and_goes_on_to_end(root: Path) -> None:
    one = flight(root, ended=False)
    faults = BridgeFaults(silent_ms=1000, speaks_again_ms=2000)
    simulation = FaultySimulation(bridge_faults=faults)
    one.mission = replace(one.mission, simulation=simulation)
    others = subprocess.Popen(["sleep", "600"])
    with subprocess.Popen(["sleep", "600"]) as child:
        one.children = Children(root, root)
        one.children.running = {"icarous_1": child, "uxas": others}
        one.failing = FailingBridge(faults, [], 500)
        one.flown = True
        try:
            for now_ms, stands in ((0, ""), (1000, "T"), (1500, "T"), (2000, ""), (1000, "T")):
                one.recorder.now_ms = now_ms
                one._fail()
                assert _stands(child, stands) == stands, now_ms
            one.close()
            assert _stands(child, "") == _stands(others, "") == ""
        finally:
            child.kill()
            others.kill()
            others.wait()


def _stands(child: subprocess.Popen[bytes], expected: str) -> str:
    """T if a process is stopped, as soon as that is as expected, or after a minute."""
    until_s = time.monotonic() + 60
    while True:
        stat = Path(f"/proc/{child.pid}/stat").read_text()
        found = "T" if stat.rpartition(")")[2].split()[0] == "T" else ""
        if found == expected or time.monotonic() > until_s:
            return found
        time.sleep(0.001)
