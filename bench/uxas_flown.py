"""An example of OpenUxAS, planned by `cratous uxas` and flown: how well it is tracked, and what its cameras see.

    python bench/uxas_flown.py EXAMPLE [--simulator "COMMAND {scenario}"] [--program /path/to/uxas] [--limit S] [--ready S]

EXAMPLE is a folder with one configuration and one scenario. The simulator, `cratous sim` at five times real time or
the command given, has to listen on port 5555, start on a line on its input or by itself, and include footprints in
its states, as OpenAMASE does. From the response on: seconds until the last TaskComplete; the distance of each state
from the legs of the mission command adjacent to its current waypoint; and the share of the tasks' lines and areas,
in points 12 m apart, that lies within the simulator's own footprints.
"""

from __future__ import annotations

import argparse
import itertools
import math
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from uxas_examples import OURS, RESPONSES, Watch, started, watched

from cratous.bridge import lmcp

APART_M, EARTH_M = 12.0, 6_371_000.0
SIMULATOR = (
    f"{sys.executable} -m cratous sim {{scenario}} --listen 127.0.0.1:5555 --clients 1 --rate 5"
)
LISTENS_S = 60.0
MET_M = 20.0
"""Within this distance a vehicle has reached its path; before the plan arrives it flies on, the farther the faster
time runs."""


class Plane(NamedTuple):
    """A local flat projection about a position [degrees]."""

    latitude: float
    longitude: float

    def of(self, places: Iterable[Any]) -> np.ndarray:
        """North and east [m], one row per position."""
        east = math.cos(math.radians(self.latitude))
        rows = [(p.Latitude - self.latitude, (p.Longitude - self.longitude) * east) for p in places]
        return EARTH_M * np.radians(np.array(rows, dtype=float).reshape(-1, 2))


class Flight(NamedTuple):
    """Messages on the bus: the newest of each object by kind and id, states from the response on, ends of tasks
    [ms]."""

    told: dict[tuple[str, int], Any]
    response: Any
    states: list[Any]
    ends_ms: dict[int, int]


def followed(watch: Watch, limit_s: float) -> Flight:
    """Observe until all tasks are complete, or for limit_s seconds of flight."""
    flight = Flight({}, None, [], {})
    for _, _, name, payload in watch.messages(time.monotonic() + 4 * limit_s):
        body = lmcp.binary.received(payload)[0]
        kind = name.rpartition(".")[2]
        if name in RESPONSES and flight.response is None:
            response = getattr(body, "OriginalResponse", body)
            # a response without a mission is not flown: another request may be answered
            flight = flight._replace(response=response if response.MissionCommandList else None)
        elif kind == "TaskComplete":
            flight.ends_ms[body.TaskID] = body.TimeTaskCompleted
        elif kind == "AirVehicleState" and flight.response is not None:
            flight.states.append(body)
        else:
            own = (getattr(body, field, 0) for field in ("TaskID", "AreaID", "LineID"))
            flight.told[kind, next(filter(None, own), 0)] = body
        if flight.response is None or not flight.states:
            continue
        tasks = {
            n
            for c in flight.response.MissionCommandList
            for w in c.WaypointList
            for n in w.AssociatedTasks
        }
        flown_s = (flight.states[-1].Time - flight.states[0].Time) / 1000
        if tasks <= flight.ends_ms.keys() or flown_s > limit_s:
            break
    return flight


def off_path_m(flight: Flight, plane: Plane) -> np.ndarray:
    """Distance [m] of each state of a vehicle with a mission from the legs adjacent to its waypoint, from when it has
    reached its path until it heads for the last waypoint."""
    found: list[float] = []
    for command in flight.response.MissionCommandList:
        own = [s for s in flight.states if command.VehicleID == s.ID]
        points = plane.of([own[0].Location, *command.WaypointList])
        met = False
        index = {w.Number: k for k, w in enumerate(command.WaypointList, 1)}
        for state in own:
            k = index.get(state.CurrentWaypoint, 0)
            if k == len(command.WaypointList) and not state.AssociatedTasks:
                break
            if k:
                near = range(max(0, k - 2), min(len(points) - 1, k + 1))
                here = plane.of([state.Location])[0]
                apart = min(_apart(here, points[j], points[j + 1]) for j in near)
                met = met or apart < MET_M
                found += [apart] if met else []
    return np.array(found)


def _apart(here: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    along = float(np.dot(b - a, b - a))
    part = min(1.0, max(0.0, float(np.dot(here - a, b - a)) / along)) if along else 0.0
    return float(np.hypot(*(here - a - part * (b - a))))


def wanted(task: Any, told: dict[tuple[str, int], Any], plane: Plane) -> np.ndarray:
    """Points that a task was to look at: of its line or area, or its position; none for other tasks."""
    line = getattr(task, "PointList", None)
    if hasattr(task, "LineID"):
        line = told["LineOfInterest", task.LineID].Line
    if line:
        ends = plane.of(line)
        parts = [
            a + (b - a) * np.linspace(0, 1, 1 + math.ceil(math.dist(a, b) / APART_M))[:, None]
            for a, b in itertools.pairwise(ends)
        ]
        return np.concatenate(parts)
    if hasattr(task, "SearchLocation"):
        return plane.of([task.SearchLocation])
    area = getattr(task, "SearchArea", None)
    if hasattr(task, "SearchAreaID"):
        area = told["AreaOfInterest", task.SearchAreaID].Area
    return plane.of([]) if area is None else _within(area, plane)


def _within(area: Any, plane: Plane) -> np.ndarray:
    """The points of a grid inside an area."""
    corners = plane.of(area.BoundaryPoints) if hasattr(area, "BoundaryPoints") else None
    middle = plane.of([area.CenterPoint])[0] if corners is None else corners.mean(axis=0)
    if corners is not None:
        reach = float(np.abs(corners - middle).max())
    else:
        reach = area.Radius if hasattr(area, "Radius") else math.hypot(area.Width, area.Height) / 2
    steps = np.arange(-reach, reach + APART_M, APART_M)
    points = middle + np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    if corners is not None:
        return points[_inside(points, corners)]
    if hasattr(area, "Radius"):
        return points[np.hypot(*(points - middle).T) <= area.Radius]
    turn = math.radians(area.Rotation)
    north = (points - middle) @ (math.cos(turn), math.sin(turn))
    east = (points - middle) @ (-math.sin(turn), math.cos(turn))
    return points[(np.abs(north) <= area.Height / 2) & (np.abs(east) <= area.Width / 2)]


def _inside(points: np.ndarray, ring: np.ndarray) -> np.ndarray:
    """Which points lie inside a ring, by the number of its crossings with a ray to the east."""
    inside = np.zeros(len(points), dtype=bool)
    for (n1, e1), (n2, e2) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        if n1 != n2:
            crosses = (n1 > points[:, 0]) != (n2 > points[:, 0])
            inside ^= crosses & (points[:, 1] < e1 + (points[:, 0] - n1) * (e2 - e1) / (n2 - n1))
    return inside


def seen(points: np.ndarray, flight: Flight, plane: Plane) -> float:
    """The share of the points inside some footprint of the states."""
    left = points
    for state in flight.states:
        for payload in state.PayloadStateList:
            ring = plane.of(getattr(payload, "Footprint", None) or [])
            if len(ring) >= 3 and len(left):
                left = left[~_inside(left, ring)]
    return 1 - len(left) / len(points)


def measured(name: str, flight: Flight) -> str:
    """A row of the table, in Markdown."""
    if flight.response is None or not flight.states or not flight.response.MissionCommandList:
        return f"| {name} | no mission | | | |"
    place = flight.states[0].Location
    plane = Plane(place.Latitude, place.Longitude)
    off = off_path_m(flight, plane)
    tasks = {
        n
        for c in flight.response.MissionCommandList
        for w in c.WaypointList
        for n in w.AssociatedTasks
    }
    shares = []
    for (kind, number), body in sorted(flight.told.items()):
        points = (
            wanted(body, flight.told, plane) if kind.endswith("Task") and number in tasks else []
        )
        if len(points):
            shares.append(f"{100 * seen(points, flight, plane):.1f} %")
    begin = flight.states[0].Time
    took = f"{(max(flight.ends_ms.values()) - begin) / 1000:.0f}" if flight.ends_ms else "-"
    done = f"{len(flight.ends_ms.keys() & tasks)} of {len(tasks)}"
    return (
        f"| {name} | {done} | {took} | {off.mean():.1f}, {np.percentile(off, 95):.1f}, {off.max():.1f} |"
        f" {', '.join(shares) or '-'} |"
    )


def flown(
    folder: Path, program: Sequence[str], simulator: str, limit_s: float, ready_s: float
) -> Flight:
    """Run one example in a copy of its folder. ready_s: time that the program has before the simulation starts [s]."""
    running: list[subprocess.Popen[Any]] = []
    with tempfile.TemporaryDirectory() as made:
        copy = Path(made) / "example"
        shutil.copytree(folder, copy)
        (file,) = (p for p in copy.glob("*cfg*.xml") if not p.name.startswith("Send"))
        (scenario,) = (p for p in copy.glob("*.xml") if "scenario" in p.name.lower())
        file.write_text(watched(file.read_text()))
        try:
            command = shlex.split(simulator.format(scenario=shlex.quote(str(scenario))))
            out = subprocess.DEVNULL
            running.append(subprocess.Popen(command, stdin=subprocess.PIPE, stdout=out, stderr=out))
            _listens(5555)
            running.append(started(program, copy, file.name))
            watch = Watch(running[1:])
            time.sleep(ready_s)
            pipe = running[0].stdin
            assert pipe is not None
            pipe.write(b"\n")
            pipe.flush()
            return followed(watch, limit_s)
        finally:
            for process in running[::-1]:
                process.terminate()
                process.wait(20)


def _listens(port: int) -> None:
    """Wait until a port is listened on, without connecting to it: a simulator may count its clients."""
    end, wanted_port = time.monotonic() + LISTENS_S, f":{port:04X}"
    while time.monotonic() < end:
        for table in ("/proc/net/tcp", "/proc/net/tcp6"):
            lines = Path(table).read_text().splitlines()[1:]
            if any(f[1].endswith(wanted_port) and f[3] == "0A" for f in map(str.split, lines)):
                return
        time.sleep(0.1)
    raise SystemExit(f"nobody listens on port {port} after {LISTENS_S:.0f} s")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("example", type=Path)
    parser.add_argument("--program", help="takes -cfgPath FILE, as uxas; ours without it")
    parser.add_argument("--simulator", default=SIMULATOR, help="{scenario} stands for the file")
    parser.add_argument("--limit", type=float, default=4000.0, help="seconds of flight")
    parser.add_argument("--ready", type=float, default=1.0, help="seconds before the flight begins")
    given = parser.parse_args()
    program = [os.path.abspath(given.program)] if given.program else OURS
    flight = flown(given.example, program, given.simulator, given.limit, given.ready)
    print(
        "| example | complete | after [s] | off the path: mean, 95th percentile, most [m] | seen |"
    )
    print("|---|---|---|---|---|")
    print(measured(given.example.name, flight))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
