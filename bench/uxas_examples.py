"""The examples of OpenUxAS, answered by `cratous uxas` or by another program with its options, one row each.

    python bench/uxas_examples.py EXAMPLES [--program /path/to/uxas] [--only 99_Tasks] [--json FILE]

EXAMPLES is OpenUxAS's own folder of that name. Each configuration is run as shipped, in a copy of its folder;
an extra bridge is added, on which this program observes, and `cratous sim` flies the example's scenario where the
configuration expects OpenAMASE (ports 5555, 5560, 5561, 9800, 9900 have to be free). Once all requests are
answered the first is sent again, `--again N` times: the answer with the median CPU time counts. Wall and CPU time are from a request to its response as they are received on that
bridge; planned seconds are the duration of each mission command from its vehicle's position, at its waypoints'
speeds, with its loiters: the longest, and the total; peak memory is resident, of all processes of the example.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge import envelope, lmcp, sentinel

OURS = [sys.executable, "-m", "cratous", "uxas"]
WATCH = 9990
REQUESTS = (
    "afrl.cmasi.AutomationRequest",
    "afrl.impact.ImpactAutomationRequest",
    "uxas.messages.task.TaskAutomationRequest",
)
RESPONSES = tuple(name.replace("Request", "Response") for name in REQUESTS)
PATIENCE_S = {"06_AutomationDiagram": 150.0, "03_Example_DistributedCooperation": 120.0}
EARTH_M = 6_371_000.0
REQUESTED = re.compile(r'MessageFileName="[^"]*AutomationRequest[^"]*"')


class Answer(NamedTuple):
    """One response: its wall and CPU time [s], the number of missions, and their durations [s]."""

    wall_s: float
    cpu_s: float
    missions: int
    longest_s: float
    all_s: float


class Row(NamedTuple):
    """The results of an example: `again` is the first request sent once more; memory [MB]."""

    name: str
    asked: int
    answers: list[Answer]
    again: Answer | None
    memory_mb: float


def examples(root: Path) -> Iterator[tuple[str, list[Path]]]:
    """Each folder with its configurations, which are processes of one system, if one of them makes a request."""
    for folder in sorted({path.parent for path in root.rglob("*cfg*.xml")}):
        files = [p for p in sorted(folder.glob("*cfg*.xml")) if not p.name.startswith("Send")]
        if any("AutomationRequest" in path.read_text() for path in files):
            yield str(folder.relative_to(root)), files


def watched(text: str) -> str:
    """A configuration with an added bridge for all messages; the last end tag may be missing."""
    letters = "".join(
        f'<SubscribeToMessage MessageType="{c}"/>' for c in "abcdefghijklmnopqrstuvwxyz"
    )
    bridge = (
        f'<Bridge Type="LmcpObjectNetworkTcpBridge" TcpAddress="tcp://*:{WATCH}" Server="TRUE">'
        f"{letters}</Bridge>"
    )
    head, end, tail = text.rpartition("</UxAS>")
    return f"{head}{bridge}{end}{tail}"


class Watch:
    """The bus of a running example, over its extra bridge."""

    def __init__(self, processes: Sequence[subprocess.Popen[bytes]]) -> None:
        self._processes = processes
        self._stream = sentinel.FrameStream()
        self._socket = _connected(WATCH, 30.0)
        self.places: dict[int, Any] = {}

    def messages(self, until: float) -> Iterator[tuple[float, float, str, bytes]]:
        """(wall, CPU [s], type, LMCP bytes) of messages as they are received."""
        while (left := until - time.monotonic()) > 0:
            self._socket.settimeout(left)
            try:
                data = self._socket.recv(1 << 16)
            except TimeoutError:
                return
            if not data:
                return
            wall, cpu = time.monotonic(), cpu_s(self._processes)
            for payload in self._stream.feed(data):
                message = envelope.parse(payload)
                name = message.address
                if name.endswith("State"):
                    state = lmcp.binary.received(message.payload)[0]
                    self.places[getattr(state, "ID", 0)] = getattr(state, "Location", None)
                yield wall, cpu, name, message.payload

    def send(self, name: str, body: bytes) -> None:
        """Send a message to the bus."""
        self._socket.sendall(sentinel.frame(envelope.enclose(name, body).pack()))


def cpu_s(processes: Sequence[subprocess.Popen[bytes]]) -> float:
    """CPU time of running processes [s], by the system's clock of each."""
    return sum(time.clock_gettime((~p.pid << 3) | 2) for p in processes if p.poll() is None)


def memory_mb(processes: Sequence[subprocess.Popen[bytes]]) -> float:
    """Peak memory of running processes [MB]."""
    total = 0.0
    for process in processes:
        status = Path(f"/proc/{process.pid}/status")
        lines = status.read_text().splitlines() if process.poll() is None else []
        total += sum(float(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))
    return total


def _connected(port: int, within_s: float) -> socket.socket:
    end = time.monotonic() + within_s
    while True:
        try:
            return socket.create_connection(("127.0.0.1", port))
        except OSError:
            if time.monotonic() > end:
                raise
            time.sleep(0.05)


def planned_s(response: Any, places: dict[int, Any]) -> list[float]:
    """The duration of each mission command of a response [s]."""
    found = []
    for mission in response.MissionCommandList:
        here, total = places.get(mission.VehicleID), 0.0
        for point in mission.WaypointList:
            if here is not None:
                total += apart_m(here, point) / max(point.Speed, 0.1)
            loiters = [a for a in point.VehicleActionList if type(a).__name__ == "LoiterAction"]
            total += sum(max(a.Duration, 0) / 1000 for a in loiters)
            here = point
        found.append(total)
    return found


def apart_m(a: Any, b: Any) -> float:
    """Horizontal distance of two positions, on a local flat approximation of a sphere [m]."""
    middle = math.radians((a.Latitude + b.Latitude) / 2)
    north, east = b.Latitude - a.Latitude, (b.Longitude - a.Longitude) * math.cos(middle)
    return EARTH_M * math.radians(math.hypot(north, east))


def answer(
    watch: Watch, asked: tuple[float, float], got: tuple[float, float], body: bytes
) -> Answer:
    """The content of a response, and the time it took."""
    response = lmcp.binary.received(body)[0]
    response = getattr(response, "OriginalResponse", response)
    times = planned_s(response, watch.places)
    return Answer(
        got[0] - asked[0], got[1] - asked[1], len(times), max(times, default=0.0), sum(times)
    )


def followed(
    watch: Watch, expected: int, patience_s: float, times: int
) -> tuple[int, list[Answer], Answer | None]:
    """The number of requests, their answers, and the answer to the first when it is sent again: the one of the
    median CPU time, if it is sent several times.
    """
    asked: list[tuple[float, float]] = []
    answers: list[Answer] = []
    first: tuple[str, bytes] | None = None
    for wall, cpu, name, body in watch.messages(time.monotonic() + patience_s):
        if name in REQUESTS:
            asked.append((wall, cpu))
            first = first or (name, body)
        elif name in RESPONSES and len(answers) < len(asked):
            answers.append(answer(watch, asked[len(answers)], (wall, cpu), body))
            if len(answers) == expected:
                break
    if first is None or len(answers) < expected:
        return len(asked), answers, None
    repeated: list[Answer] = []
    while len(repeated) < times:
        for _ in watch.messages(time.monotonic() + (0.5 if repeated else 2.0)):
            pass
        again = asked_again(watch, first, patience_s)
        if again is None:
            break
        repeated.append(again)
    repeated.sort(key=lambda one: one.cpu_s)
    return len(asked), answers, repeated[len(repeated) // 2] if repeated else None


def asked_again(watch: Watch, request: tuple[str, bytes], patience_s: float) -> Answer | None:
    """The answer to a request that is sent now."""
    watch.send(*request)
    begin = (time.monotonic(), cpu_s(watch._processes))
    for wall, cpu, name, body in watch.messages(time.monotonic() + patience_s):
        if name in RESPONSES:
            return answer(watch, begin, (wall, cpu), body)
    return None


def row(name: str, files: Sequence[Path], program: Sequence[str], times: int) -> Row:
    """Run one example in a copy of its folder; times: how often its first request is sent again."""
    running: list[subprocess.Popen[bytes]] = []
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made) / "example"
        shutil.copytree(files[0].parent, folder)
        texts = [path.read_text() for path in files]
        texts[-1 if "Test_Sim" in texts[-1] else 0] = watched(
            texts[-1 if "Test_Sim" in texts[-1] else 0]
        )
        for path, text in zip(files, texts, strict=True):
            (folder / path.name).write_text(text)
        try:
            simulator = started_simulator(folder, texts)
            running += simulator
            if simulator:
                time.sleep(2.0)
            answering = [started(program, folder, path.name) for path in files]
            running += answering
            try:
                watch = Watch(answering)
            except OSError:
                return Row(name, 0, [], None, memory_mb(answering))
            expected = max(
                text.count("AutomationRequest") - text.count("AutomationRequestV") for text in texts
            )
            found = followed(watch, expected, PATIENCE_S.get(name, 60.0), times)
            return Row(name, *found, memory_mb(answering))
        finally:
            for process in running[::-1]:
                process.terminate()
                try:
                    process.wait(5)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()


def started(program: Sequence[str], folder: Path, name: str) -> subprocess.Popen[bytes]:
    """Start one process of an example, in a folder beside its messages."""
    run = folder / f"RUNDIR_{name}"
    (run / "log").mkdir(parents=True)
    out = subprocess.DEVNULL
    return subprocess.Popen([*program, "-cfgPath", f"../{name}"], cwd=run, stdout=out, stderr=out)


def started_simulator(folder: Path, texts: Sequence[str]) -> list[subprocess.Popen[bytes]]:
    """Start the simulator with the example's scenario, if a configuration expects one."""
    ports = [p for p in ("5555", "9800", "9900") if any(f"127.0.0.1:{p}" in t for t in texts)]
    scenarios = [p for p in sorted(folder.glob("*.xml")) if "scenario" in p.name.lower()]
    if not ports or not scenarios:
        return []
    vehicles = {"9800": "1000", "9900": "2000"}
    own = [f"--vehicle={vehicles[p]}=127.0.0.1:{p}" for p in ports if p in vehicles]
    command = [
        sys.executable,
        "-m",
        "cratous",
        "sim",
        str(scenarios[0]),
        "--listen",
        "127.0.0.1:5555",
    ]
    out = subprocess.DEVNULL
    return [
        subprocess.Popen([*command, "--clients", str(len(ports)), *own], stdout=out, stderr=out)
    ]


def printed(one: Row) -> str:
    """A row of the table, in Markdown."""

    def pair(a: Answer | None) -> str:
        return f"{a.wall_s:.3f} ({a.cpu_s:.3f})" if a else "-"

    answers = one.answers
    planned = ", ".join(f"{a.longest_s:.0f} ({a.all_s:.0f})" for a in answers if a.missions) or "-"
    missions = "+".join(str(a.missions) for a in answers) or "0"
    said = f"{len(answers)} of {one.asked} ({missions} missions)"
    first = pair(answers[0] if answers else None)
    return (
        f"| {one.name} | {said} | {planned} | {first} | {pair(one.again)} | {one.memory_mb:.0f} |"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("examples", type=Path)
    parser.add_argument("--program", help="takes -cfgPath FILE, as uxas; ours without it")
    parser.add_argument("--only", default="", help="a part of the folders' names")
    parser.add_argument("--again", type=int, default=1, help="how often the first is sent again")
    parser.add_argument("--json", type=Path, help="the rows as JSON, too")
    given = parser.parse_args()
    program = [os.path.abspath(given.program)] if given.program else OURS
    rows = []
    print("| example | answers | planned, longest (all) [s] | first: wall (CPU) [s] | again | MB |")
    print("|---|---|---|---|---|--:|")
    for name, files in examples(given.examples):
        if given.only in name:
            rows.append(row(name, files, program, given.again))
            print(printed(rows[-1]), flush=True)
    if given.json:
        made = [
            one._asdict()
            | {
                "answers": [a._asdict() for a in one.answers],
                "again": one.again._asdict() if one.again else None,
            }
            for one in rows
        ]
        given.json.write_text(json.dumps(made, indent=1))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
