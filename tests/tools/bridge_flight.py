"""A stub simulator for tests of the bridge between processes: `cratous uxas`, `cratous icarous`, and here the
aircraft, which fly what they are told over UxAS's TCP bridge."""

from __future__ import annotations

import contextlib
import itertools
import math
import os
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from uxas_tools import Client, ended, free_port

from cratous.bridge import lmcp
from cratous.core.routing.polylines import Track
from cratous.services.flight.autopilot import Command, Follow, decide, track_progress
from cratous.services.flight.commands import decode
from cratous.services.flight.dynamics import AirState, Limits, advance, steer
from cratous.services.mission.frames import Projection, compass
from cratous.spec.mission import Frame, Position

FRAME = Frame(45.0, -121.0, 0.0)
PLANE = Projection(FRAME)
LIMITS = Limits(15.0, 33.0, math.radians(30.0), 5.0)
STEP_S, BEAT_MS = 0.25, 500
WAY = ((0.0, 0.0), (1500.0, 0.0), (3500.0, 0.0), (4500.0, 0.0))
TASK = 7
MISSION = """
name: bridge
frame: {latitude_deg: 45, longitude_deg: -121}
vehicles:
  - id: %d
    position: {north_m: 0, east_m: 0, alt_m: 300}
    heading_deg: 0
    speed_m_s: 22
    min_speed_m_s: 15
    max_speed_m_s: 33
    max_bank_deg: 30
    max_climb_m_s: 5
tasks:
  - {id: 1, kind: must_fly, points: [{north_m: 5000, east_m: 0, alt_m: 300}]}
daa:
  well_clear: {dthr_m: 150, zthr_m: 30, tthr_s: 15, tcoa_s: 0}
"""
CFG = """<UxAS FormatVersion="1.0" EntityID="100" EntityType="Aircraft">
  <Bridge Type="LmcpObjectNetworkTcpBridge" TcpAddress="tcp://127.0.0.1:{sim}" Server="TRUE">
    <SubscribeToMessage MessageType="afrl.cmasi"/>
    <SubscribeToMessage MessageType="uxas.messages.task"/>
    <SubscribeToMessage MessageType="cratous"/>
  </Bridge>
  <Service Type="IcarousCommunicationService" {where}="tcp://127.0.0.1:{ics}" {more}/>
</UxAS>
"""


def configuration(folder: Path, more: str, connect: int | None = None) -> tuple[Path, int, int]:
    """A cfg.xml in a folder, and the ports of simulator and ICAROUS. more: of the service, which has no keys where no
    dialect is said; connect: there ICAROUS listens."""
    if "Dialect" not in more:
        more += ' Dialect="cratous"'
    sim, ics = free_port(), connect or free_port()
    path, where = folder / "cfg.xml", "Address" if connect is None else "Connect"
    path.write_text(CFG.format(sim=sim, ics=ics, more=more, where=where))
    return path, sim, ics


def mission_file(folder: Path, vehicle: int = 1) -> Path:
    path = folder / "mission.yaml"
    path.write_text(MISSION % vehicle)
    return path


@contextlib.contextmanager
def command(folder: Path, *arguments: str) -> Iterator[subprocess.Popen[str]]:
    """A command of the product as a process of its own, ended by its pid."""
    with (folder / f"said_{arguments[0]}_{time.monotonic_ns()}").open("w") as said:
        running = subprocess.Popen(
            [sys.executable, "-m", "cratous", *arguments],
            cwd=folder, stdout=said, stderr=subprocess.STDOUT, text=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )  # fmt: skip
        with ended(running):
            yield running


def icarous(folder: Path, port: int, *more: str, vehicle: int = 1, end: str = "--connect") -> Any:
    """`cratous icarous` for a vehicle of `mission_file`, without keys where no dialect is said. end: --connect or
    --listen."""
    if not {"--v2", "--thesis", "--original"} & set(more):
        more += ("--plain",)
    mission = mission_file(folder, vehicle)
    return command(
        folder, "icarous", "--vehicle", str(vehicle), "--mission", str(mission),
        end, f"127.0.0.1:{port}", *more,
    )  # fmt: skip


def said(folder: Path) -> str:
    """All that the processes of a folder have said and logged."""
    files = [*folder.glob("said_*"), *folder.rglob("log_*")]
    return "\n".join(file.read_text(errors="replace") for file in files if file.is_file())


def listening(folder: Path) -> None:
    """Wait until the `cratous uxas` of a folder waits for its ICAROUS; it may have to start first."""
    end = time.monotonic() + 120.0
    while "waiting: 0 of 1" not in said(folder):
        assert time.monotonic() < end, said(folder)
        time.sleep(0.02)


def way(*points: tuple[float, float], vehicle: int = 1) -> Any:
    """A MissionCommand through these places at 300 m and 22 m/s, for task 7."""
    waypoints = []
    for k, (north, east) in enumerate(points, 1):
        lat, lon = PLANE.to_geodetic(north, east)
        waypoints.append(
            lmcp.new(
                "Waypoint", Number=k, NextWaypoint=min(k + 1, len(points)), Latitude=lat,
                Longitude=lon, Altitude=300.0, Speed=22.0, AssociatedTasks=[TASK],
            )
        )  # fmt: skip
    return lmcp.new(
        "MissionCommand", VehicleID=vehicle, CommandID=1, FirstWaypoint=1, WaypointList=waypoints
    )


class Aircraft:
    """A vehicle that flies the newest command; or one that flies straight on, without any."""

    def __init__(self, vehicle: int, north: float, east: float, heading_deg: float) -> None:
        self.id, self.waypoint = vehicle, 0
        self.air = AirState(Position(north, east, 300.0), math.radians(heading_deg), 22.0, 0.0)
        self.flies: Command | None = None
        self.numbers: list[int] = []
        self.passed: list[int] = []
        self.plan: Any = None
        self.steered = False

    def told(self, body: Any) -> None:
        """A MissionCommand or VehicleActionCommand; GoToWaypointAction goes on with the last plan from there."""
        for action in getattr(body, "VehicleActionList", ()):
            if type(action).__name__ == "GoToWaypointAction":
                body = self.plan.copy(FirstWaypoint=action.WaypointNumber)
        self.steered = type(body).__name__ == "VehicleActionCommand"
        if self.steered:
            self.flies = decode(PLANE, body, self.air.heading_rad)
            return
        self.plan = body
        known = {w.Number: w for w in body.WaypointList}
        number, order = body.FirstWaypoint, []
        while number in known:
            order.append(known.pop(number))
            number = order[-1].NextWaypoint
        points = [Position(*PLANE.to_local(w.Latitude, w.Longitude), w.Altitude) for w in order]
        self.flies = Follow(Track((self.air.position, *points)), order[0].Speed)
        self.numbers = [w.Number for w in order]
        self.waypoint = self.numbers[0]

    def step(self) -> None:
        if isinstance(self.flies, Follow):
            self.flies, _ = track_progress(self.flies, self.air, STEP_S)
            marks = self.flies.track.s_m[1:]
            left = sum(mark > self.flies.s_m for mark in marks)
            done = self.numbers[: len(self.numbers) - left]
            self.passed += [n for n in done if n not in self.passed]
            self.waypoint = self.numbers[min(len(done), len(self.numbers) - 1)]
        if self.flies is not None:
            self.air = steer(self.air, decide(self.flies, self.air, LIMITS, STEP_S), LIMITS, STEP_S)
        self.air = advance(self.air, STEP_S)

    def state(self, now_ms: int) -> Any:
        p, s = self.air.position, self.air
        lat, lon = PLANE.to_geodetic(p.north_m, p.east_m)
        heading = compass(s.heading_rad)
        return lmcp.new(
            "AirVehicleState", ID=self.id, Time=now_ms, u=s.speed_m_s, w=-s.climb_m_s,
            Heading=heading, Course=heading, Groundspeed=s.speed_m_s, Airspeed=s.speed_m_s,
            VerticalSpeed=s.climb_m_s, CurrentWaypoint=self.waypoint,
            AssociatedTasks=[TASK] if self.waypoint else [],
            Location=lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=p.alt_m),
        )  # fmt: skip


class Proxy:
    """Between UxAS and an ICAROUS: hands lines on, those from UxAS as `change` makes them."""

    def __init__(self, port: int) -> None:
        """port: where UxAS listens."""
        self._uxas, self.change = port, lambda line: line
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._listener.getsockname()[1])
        self._sockets: list[socket.socket] = []
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                below, _ = self._listener.accept()
                try:
                    above = socket.create_connection(("127.0.0.1", self._uxas), timeout=60)
                except ConnectionRefusedError:  # UxAS does not listen yet
                    below.close()
                    continue
                above.settimeout(None)
                for end in (below, above):
                    end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._sockets += [below, above]
                for source, target, change in ((above, below, True), (below, above, False)):
                    pair = (source, target, change)
                    threading.Thread(target=self._carry, args=pair, daemon=True).start()

    def _carry(self, source: socket.socket, target: socket.socket, change: bool) -> None:
        pending = b""
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                pending += data
                lines = pending.splitlines(keepends=True)
                pending = b""
                # the handshake has no newlines; messages begin with a tag and end with one
                whole = not lines or lines[-1].endswith(b"\n")
                if not whole and re.match(rb"[A-Z]{5},", lines[-1]):
                    pending = lines.pop()
                target.sendall(b"".join(self.change(x) if change else x for x in lines))
        for end in (source, target):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def cut(self) -> None:
        """The connections end; new ones are carried."""
        for one in self._sockets:
            with contextlib.suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()
        self._sockets.clear()

    def close(self) -> None:
        self._listener.close()
        self.cut()


class Simulator:
    """Steps of half a second: states out, then the answer of vehicle 1's ICAROUS, then what it steers."""

    def __init__(self, port: int, own: Aircraft, *others: Aircraft) -> None:
        self.client, self.own, self.others = Client(port), own, others
        self.now_ms, self.nearest_m, self.read = 0, math.inf, 0
        self.got: list[Any] = []
        assert self.wait(lambda: self.all("BridgeStatus")), "no ICAROUS has come"

    def all(self, kind: str) -> list[Any]:
        return [body for body in self.got if type(body).__name__ == kind]

    def listen(self) -> list[Any]:
        """What has come since the last call."""
        messages = self.client.read()
        new = [lmcp.binary.unpack(m.payload) for m in messages[self.read :]]
        self.read = len(messages)
        self.got += new
        for body in new:
            command = type(body).__name__ in ("MissionCommand", "VehicleActionCommand")
            if command and body.VehicleID == self.own.id:
                self.own.told(body)
        return new

    def beats(self) -> int:
        """Heartbeats that have come up from ICAROUS."""
        return sum(b.Direction.name == "Up" for b in self.all("Heartbeat"))

    def wait(self, done: Any, limit_s: float = 120.0) -> bool:
        """Listen until something is so; False when the time is over."""
        end = time.monotonic() + limit_s
        while not done():
            if time.monotonic() > end:
                return False
            self.listen()
            time.sleep(0.002)
        return True

    def beat(self, limit_s: float = 120.0) -> bool:
        """One heartbeat; False if ICAROUS does not answer."""
        before = self.beats()
        for craft in (*self.others, self.own):
            self.client.send(craft.state(self.now_ms), 1, 1)
        answered = self.wait(lambda: self.beats() > before, limit_s)
        for _ in range(round(BEAT_MS / 1000 / STEP_S)):
            for craft in (self.own, *self.others):
                craft.step()
            for other in self.others:
                p, q = self.own.air.position, other.air.position
                apart = math.hypot(p.north_m - q.north_m, p.east_m - q.east_m)
                if abs(p.alt_m - q.alt_m) < 30.0:
                    self.nearest_m = min(self.nearest_m, apart)
        self.now_ms += BEAT_MS
        return answered

    def fly(self, beats: int, done: Any = lambda: False) -> bool:
        """Until something is so; False if that never is, in so many heartbeats."""
        for _ in itertools.repeat(None, beats):
            assert self.beat(), "ICAROUS does not answer"
            if done():
                return True
        return False

    def close(self) -> None:
        self.client.close()
