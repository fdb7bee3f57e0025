"""Processes of a flight: they are told apart when they end, none stays, and their flight is that of one process."""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from simulator_tools import mission as commanded
from simulator_tools import scenario, waypoint
from uxas_tools import ended

from cratous.services.cli import main
from cratous.services.processes import children as children_module
from cratous.services.processes.children import LOWEST, Children, ProcessEnded, free_port
from cratous.services.processes.leash import ENDS_WITH

LIMIT_S = 600.0
STARTED = "process icarous_2: pid"
"""What is said of the process that starts last."""
FLIGHT = commanded(waypoint(1, 2, 45.02), waypoint(2, 2, 45.1))


def stands(pid: int) -> bool:
    """Whether a process runs, or waits for nobody to ask after it."""
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except (
        FileNotFoundError,
        ProcessLookupError,
    ):  # gone before it was opened, or before it was read
        return False


def simulator(children: Children, folder: Path, name: str) -> int:
    path = folder / "scenario.xml"
    path.write_text(scenario(FLIGHT))
    return children.start(name, "sim", str(path), "--listen", "127.0.0.1:0")


def until(done: Callable[[], object]) -> None:
    end = time.monotonic() + LIMIT_S
    while not done():
        assert time.monotonic() < end, "the time limit is over"
        time.sleep(0.05)


def test_one_that_ends_is_named_with_its_exit_code_and_last_lines(tmp_path: Path) -> None:
    with Children(tmp_path, tmp_path) as children:
        pid = simulator(children, tmp_path, "simulator")
        until(lambda: "listening" in children.said("simulator"))
        children.watch()
        children.start("broken", "sim", "no such file.xml")
        with pytest.raises(ProcessEnded) as wrong:
            until(children.watch)
        assert (wrong.value.name, wrong.value.code, wrong.value.exit_code) == ("broken", 2, 3)
        assert "no such file.xml" in str(wrong.value)
        os.kill(pid, signal.SIGKILL)
        until(lambda: not stands(pid))
        del children.running["broken"]
        with pytest.raises(ProcessEnded, match=r"simulator has ended .*signal SIGKILL"):
            children.watch()


@pytest.mark.long
def test_none_stays_not_even_one_that_does_not_listen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(children_module, "GRACE_S", 30.0)  # the other one may be slow to end
    with Children(tmp_path, tmp_path) as children:
        pids = [simulator(children, tmp_path, name) for name in ("one", "two")]
        until(lambda: "listening" in children.said("one") and "listening" in children.said("two"))
        os.kill(pids[0], signal.SIGSTOP)
        assert children.end() == {"one": -signal.SIGKILL, "two": 0}
    assert not any(map(stands, pids))


OWNER = """
import os, signal, sys
from pathlib import Path
from cratous.services.processes.children import Children
folder = Path(sys.argv[1])
children = Children(folder, folder)
print(children.start("simulator", "sim", str(folder / "scenario.xml"), "--listen", "127.0.0.1:0"), flush=True)
while "listening" not in children.said("simulator"):
    children.watch()
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_one_whose_owner_is_killed_ends_as_well(tmp_path: Path) -> None:
    (tmp_path / "scenario.xml").write_text(scenario(FLIGHT))
    owner = subprocess.run(
        [sys.executable, "-c", OWNER, str(tmp_path)], stdout=subprocess.PIPE, check=False
    )
    assert owner.returncode == -signal.SIGKILL
    pid = int(owner.stdout)
    until(lambda: not stands(pid))
    assert "ended at" in (tmp_path / "simulator.txt").read_text(), "in order, as by SIGTERM"


STOPPED = """
import os, signal, subprocess, sys
from cratous.services.processes.leash import AT_ONCE, ENDS_WITH
words = "from cratous.services.processes.leash import end_with_parent; end_with_parent(); print(); input()"
child = subprocess.Popen(
    [sys.executable, "-c", words], env={**os.environ, ENDS_WITH: f"{os.getpid()}{AT_ONCE}"},
    stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True,
)
child.stdout.readline()
child.send_signal(signal.SIGSTOP)
os.waitid(os.P_PID, child.pid, os.WSTOPPED)
print(child.pid, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_one_that_stands_still_as_its_owner_is_killed_is_not_left_behind() -> None:
    owner = subprocess.run([sys.executable, "-c", STOPPED], stdout=subprocess.PIPE, check=False)
    assert owner.returncode == -signal.SIGKILL
    pid = int(owner.stdout)
    try:
        until(lambda: not stands(pid))
    finally:
        if stands(pid):
            os.kill(pid, signal.SIGKILL)


def test_one_whose_owner_has_ended_already_does_not_begin() -> None:
    environment = {**os.environ, ENDS_WITH: str(os.getppid())}
    words = [sys.executable, "-m", "cratous", "version"]
    begun = subprocess.run(words, env=environment, capture_output=True, check=False)
    assert (begun.returncode, begun.stdout) == (128 + signal.SIGTERM, b"")


def test_a_second_request_to_end_waits_until_all_have_ended(tmp_path: Path) -> None:
    class Slow(Children):
        def end(self) -> dict[str, int]:
            signal.raise_signal(signal.SIGINT)
            return super().end()

    children = Slow(tmp_path, tmp_path)
    pid = simulator(children, tmp_path, "simulator")
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            children.__exit__(None, None, None)
    finally:
        signal.signal(signal.SIGINT, before)
    assert not stands(pid)


def test_they_are_the_same_program_in_any_folder(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(root)
    monkeypatch.setenv("PYTHONPATH", "src")
    with Children(tmp_path, tmp_path) as children:
        pid = simulator(children, tmp_path, "simulator")
        # empty for a moment while the system still sets the program up
        until(lambda: Path(f"/proc/{pid}/environ").read_text())
        environment = Path(f"/proc/{pid}/environ").read_text().split("\0")
    (paths,) = [x.partition("=")[2] for x in environment if x.startswith("PYTHONPATH=")]
    place = Path(paths.split(os.pathsep)[0])
    assert place.is_absolute(), "it is not of this folder that the process runs in"
    assert (place / "cratous").samefile(root / "src/cratous")


def test_a_free_port_is_none_that_the_system_gives_to_another_program_s_connection() -> None:
    text = Path("/proc/sys/net/ipv4/ip_local_port_range").read_text()
    first, last = map(int, text.split())
    if first <= LOWEST:
        pytest.skip("the system may choose any port")
    ports = [free_port() for _ in range(200)]
    assert not [port for port in ports if first <= port <= last]
    assert len(set(ports)) > 190, "and hardly ever the one that it gave before"
    held = socket.create_server(("127.0.0.1", ports[0]))
    with held, pytest.MonkeyPatch.context() as patch:
        numbers = iter((ports[0], ports[1]))
        patch.setattr(children_module, "_unassigned", lambda: next(numbers))
        assert free_port() == ports[1], "where somebody listens is no free port"
    with pytest.MonkeyPatch.context() as patch:
        again = iter((ports[1], ports[1], ports[2]))
        patch.setattr(children_module, "_unassigned", lambda: next(again))
        assert free_port() == ports[2], "two processes of a flight never get the same one"


@contextlib.contextmanager
def flying(root: Path, folder: Path, rate: float) -> Iterator[tuple[Any, Path]]:
    """`cratous run --processes` on the crossing, and the file of what it says."""
    said = folder / "said"
    with said.open("w") as stream:
        running = subprocess.Popen(
            [sys.executable, "-m", "cratous", "run", str(root / "examples/crossing/mission.yaml"),
             "--processes", "--rate", str(rate), "--out", str(folder / "out"), "--allow-unproved"],
            stdout=stream, stderr=subprocess.STDOUT,
        )  # fmt: skip
        with ended(running):
            yield running, said


def pids_once_started(running: Any, said: Path) -> dict[str, int]:
    """The processes of a flight by name, once all have begun or it has ended."""
    until(lambda: STARTED in said.read_text() or running.poll() is not None)
    found = re.findall(r"process (\w+): pid (\d+)", said.read_text())
    return {name: int(pid) for name, pid in found}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["icarous_2", "simulator"])
def test_a_process_that_dies_ends_the_flight_with_3_and_no_requirement_holds(
    root: Path, tmp_path: Path, name: str
) -> None:
    with flying(root, tmp_path, 4) as (running, said):
        pids = pids_once_started(running, said)
        assert sorted(pids) == ["icarous_1", "icarous_2", "simulator", "uxas"], said.read_text()
        states = tmp_path / "out"
        until(lambda: _commanded(states) or running.poll() is not None)
        os.kill(pids[name], signal.SIGKILL)
        assert running.wait(LIMIT_S) == 3, said.read_text()
    assert f"{name} has ended before its time (signal SIGKILL)" in said.read_text()
    assert not any(map(stands, pids.values()))
    report = json.loads((tmp_path / "out/crossing/report.json").read_text())
    assert report["exit_code"] == 3
    assert not [r for r in report["requirements"] if r["verdict"] == "holds"]
    assert main(["judge", str(tmp_path / "out/crossing")]) == 3


def _commanded(out: Path) -> bool:
    """Whether the clock of the simulator runs at the rate of the flight."""
    return any("asks: Running" in p.read_text() for p in out.glob(".*/*/simulator.txt"))


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_asked_to_end_it_leaves_no_process_and_no_results(
    root: Path, tmp_path: Path, number: int
) -> None:
    with flying(root, tmp_path, 1) as (running, said):
        pids = pids_once_started(running, said)
        running.send_signal(number)
        assert running.wait(LIMIT_S) == 128 + number
    assert len(pids) == 4, said.read_text()
    assert not any(map(stands, pids.values()))
    assert not (tmp_path / "out/crossing").exists()


@pytest.mark.long
def test_it_decides_as_the_flight_in_one_process(
    root: Path, tmp_path: Path, fly_once: Callable[[Path], Path]
) -> None:
    """Same assignment and order; tasks of vehicles that are not taken over end within heartbeats."""
    mission = root / "examples/crossing/mission.yaml"
    virtual = json.loads((fly_once(mission) / "report.json").read_text())
    with flying(root, tmp_path, 1) as (running, said):
        assert running.wait(LIMIT_S) in (1, 3), said.read_text()
    folder = tmp_path / "out/crossing"
    flown = json.loads((folder / "report.json").read_text())
    text = "flown in 4 processes: the simulator, UxAS and 2 of ICAROUS"
    assert any(note.startswith(text) for note in flown["mission"]["notes"])
    for key in ("task_id", "vehicle_id", "option_id", "start_ms", "end_ms"):
        assert [i[key] for i in flown["plan"]["items"]] == [
            i[key] for i in virtual["plan"]["items"]
        ]
    assert flown["flight"]["outcome"] == virtual["flight"]["outcome"] == "complete"
    taken = {t["vehicle"] for report in (flown, virtual) for t in report["flight"]["takeovers"]}
    served = [{s["task"]: s for s in r["flight"]["served"]} for r in (flown, virtual)]
    assert served[0].keys() == served[1].keys()
    for task, one in served[0].items():
        other = served[1][task]
        assert (one["vehicle"], one["phase"]) == (other["vehicle"], other["phase"])
        if one["vehicle"] not in taken:
            assert abs(one["time_ms"] - other["time_ms"]) <= 4 * 500
    assert flown["flight"]["takeovers"], "somebody has to give way"
    by_id = {r["requirement"]: r["verdict"] for r in flown["requirements"]}
    # G5 is about the machine's time: a loaded one may be late
    assert [by_id[g] for g in ("G1", "G2", "G3", "G4")] == ["holds"] * 4
    # the gate is in UxAS here, so theorems of a gate on board say nothing of this flight
    assert [a for a in flown["assumptions"] if a["state"] == "broken"]
    assert flown["exit_code"] == (3 if by_id["G5"] == "holds" else 1)
    assert main(["certify", str(folder)]) == flown["exit_code"]
    assert main(["monitor", str(folder)]) == flown["exit_code"]
    assert main(["judge", str(folder)]) == (0 if by_id["G5"] == "holds" else 1)
