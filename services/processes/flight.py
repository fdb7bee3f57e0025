"""The flight in processes: starts them in order, starts the clock, monitors them, and ends them all.

The clock of the simulator is stopped from its first states until UxAS has made the checked plan and the simulator has
its commands."""

from __future__ import annotations

import re
import signal
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any, NamedTuple

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.port import Incoming, Limits, address, is_due
from cratous.bridge.tcp_port import TcpPort
from cratous.bridge.text_protocol.keys import Keys, new_keys
from cratous.services.exporting.messages import Told
from cratous.services.processes.agreement import agrees
from cratous.services.processes.amase import Amase, AmaseLost
from cratous.services.processes.children import GRACE_S, Children, ProcessEnded, free_port
from cratous.services.processes.direct_links import DirectLinks
from cratous.services.processes.ending import Ending
from cratous.services.processes.failing_bridge import FailingBridge
from cratous.services.processes.files import (
    ORIGINAL_PORT,
    Ports,
    write_configuration,
    write_messages,
    write_scenario,
)
from cratous.services.processes.recorder import Recorder
from cratous.spec.errors import BadInput, CratousError, NoPlan
from cratous.spec.mission import FaultySimulation, Mission
from cratous.spec.mission.plan import Plan

Tell = Callable[[str], None]
SIMULATOR, UXAS = "simulator", "uxas"
STARTS_S = 600.0
"""Time limit for starting all processes, which check the proofs first [s]."""
SILENCE_S = 60.0
"""A simulator whose clock runs counts as stuck without a state for this long [s]; so does UxAS without a message,
since it reports each heartbeat of an ICAROUS instance, unless it hears none of them."""
PROGRESS_MS = 10_000
LIMITS = Limits(waiting_bytes=64 << 20)
LOOK_S = 0.2
"""Longest interval between checks of the processes, whatever the load [s]."""


class Stuck(CratousError):
    """A process runs, but its expected output does not arrive."""

    exit_code = 3


class Flying(NamedTuple):
    """Setup of a flight in processes.

    path: of the mission, for ICAROUS; digest: hash of that mission in the report; folder: for input files and output;
    rate: multiple of real time; original: ICAROUS runs behind clients of the original's, started by the user; amase:
    replaces our simulator; direct: links between the ICAROUS processes."""

    path: Path
    digest: str
    folder: Path
    rate: float
    allow_unproved: bool
    tell: Tell
    original: bool = False
    amase: Amase | None = None
    direct: DirectLinks | None = None


class Ended(NamedTuple):
    """outcome: of the mission, "" if unknown; why: what went wrong; pids, ports: by name."""

    outcome: str
    why: str
    pids: dict[str, int]
    ports: dict[str, int]


def fly(mission: Mission, plan: Plan, told: Told, recorder: Recorder, how: Flying) -> Ended:
    """Fly a plan in separate processes and record it; see the module.

    ProcessEnded, Stuck or NoPlan if the flight does not start; later failures are in the result."""
    with (
        TemporaryDirectory(prefix="cratous-") as work,
        Children(how.folder, Path(work)) as children,
    ):
        flight = _Flight(mission, plan, told, recorder, how, children)
        try:
            flight.start()
            return flight.run()
        finally:
            flight.close()


class _Flight:
    """The processes, the recorder's two connections, and what was received over them."""

    def __init__(
        self,
        mission: Mission,
        plan: Plan,
        told: Told,
        recorder: Recorder,
        how: Flying,
        children: Children,
    ) -> None:
        self.mission, self.plan, self.told = mission, plan, told
        self.recorder, self.how, self.children = recorder, how, children
        self.ports = Ports(0, 0, 0)
        self.simulator: TcpPort | None = None
        self.uxas: TcpPort | None = None
        self.there: set[int] = set()
        self.commanded: set[int] = set()
        self.heard: list[Any] = []
        self.flown = False
        self.ending = Ending(plan, mission.bridge_times.safe_state_after_ms)
        self.news_s: dict[str, float] = {}
        self.look_s = 0.0
        self.stood: set[str] = set()
        self.failing: FailingBridge | None = None
        self.stands = False
        # unique to this flight and to each ICAROUS: no other process can impersonate one
        self.keys = Keys({}) if how.original else new_keys(mission.instances)

    # the start ------------------------------------------------------------------------------------

    def start(self) -> None:
        """Start all processes in order; then the plan is made, checked and commanded, and the clock starts."""
        how, mission = self.how, self.mission
        write_messages(self.told, how.folder)
        if how.amase is not None:
            port = how.amase.port
        else:
            port = self._start_simulator(write_scenario(mission, self.told, how.folder))
            self._wait("the simulator's first states", self._all_there)
            self._control("Paused", 1.0)
        icarous = ORIGINAL_PORT if how.original else free_port()
        self.ports = ports = Ports(port, free_port(), icarous)
        instances = sorted(mission.instances)
        cfg = write_configuration(mission, instances, ports, how.folder, how.original)
        unproved = ("--allow-unproved",) * how.allow_unproved
        self._start(UXAS, "uxas", "-cfgPath", str(cfg.resolve()), *unproved, keys=self.keys)
        how.tell(f"ports of 127.0.0.1: {_words(ports)}")
        self.uxas = self._connect(ports.recorder)
        # UxAS waits for its ICAROUS instances before it sends anything, so nothing is missed
        self._wait("UxAS", lambda: self.uxas is not None and self.uxas.peers == 1)
        if how.original:
            who = ", then ".join(map(str, instances))
            how.tell(
                f"start the original's clients, for vehicle {who}: UxAS waits for {len(instances)}"
            )
        doors, direct = self._doors(instances), how.direct
        for vehicle in () if how.original else instances:
            self._start(
                f"icarous_{vehicle}", "icarous", "--vehicle", str(vehicle), "--mission",
                str(how.path.resolve()), "--mission-hash", how.digest,
                "--connect", f"127.0.0.1:{doors[vehicle]}", "--wait", f"{STARTS_S:g}", *unproved, *(direct.words if direct else ()),
                may_stand=self.failing is not None, keys=self.keys.of(vehicle),
                more=direct.private if direct else {},
            )  # fmt: skip
        self._wait("UxAS's plan", self._planned)
        self._wait("the commands of UxAS at the simulator", self._all_commanded)
        self.recorder.accepted(self.plan)
        for body in self.heard:
            self.recorder.heard(body)
        self.heard.clear()
        self.flown = True
        if how.amase is None:
            self._control("Running", how.rate)
            return
        how.amase.begin(mission, self.told)
        self._wait("AMASE to fly the aircraft (its clock has to run)", self._all_there)

    def _doors(self, instances: list[int]) -> dict[int, int]:
        """The port for each vehicle's ICAROUS: UxAS's, or that of the bridge with injected faults."""
        simulation = self.mission.simulation
        if not isinstance(simulation, FaultySimulation):
            return dict.fromkeys(instances, self.ports.icarous)
        faults = simulation.bridge_faults
        self.failing = FailingBridge(faults, instances, simulation.heartbeat_ms)
        self.failing.leads_to(self.ports.icarous)
        return self.failing.ports

    def _fail(self) -> int:
        """Run the bridge with injected faults, and stop or continue ICAROUS; returns the number of bytes forwarded."""
        simulation, now_ms = self.mission.simulation, self.recorder.now_ms
        if self.failing is None or not isinstance(simulation, FaultySimulation):
            return 0
        silent = simulation.bridge_faults.icarous_is_silent(now_ms) and self.flown
        if silent != self.stands:
            self.stands = silent
            self.children.signalled("icarous_", signal.SIGSTOP if silent else signal.SIGCONT)
        return self.failing.step(now_ms, self.flown)

    def _start(
        self,
        name: str,
        *arguments: str,
        may_stand: bool = False,
        keys: Keys = Keys({}),
        more: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        private = {**keys.environment(), **more}
        pid = self.children.start(name, *arguments, may_stand=may_stand, private=private)
        self.how.tell(f"process {name}: pid {pid}")

    def _start_simulator(self, scenario: Path) -> int:
        self._start(SIMULATOR, "sim", str(scenario.resolve()), "--listen", "127.0.0.1:0",
                    "--clients", "1", "--only", "2")  # fmt: skip
        found: list[re.Match[str]] = []

        def listens() -> bool:
            match = re.search(r"listening on 127\.0\.0\.1:(\d+)", self.children.said(SIMULATOR))
            found.extend([match] if match else [])
            return bool(found)

        self._wait("the simulator's port", listens)
        port = int(found[0][1])
        self.simulator = self._connect(port)
        return port

    def _connect(self, port: int) -> TcpPort:
        where = address(f"tcp://127.0.0.1:{port}", ("tcp",))
        return TcpPort(where, server=False, limits=LIMITS)

    def _all_there(self) -> bool:
        return self.there >= {v.id for v in self.mission.vehicles}

    def _planned(self) -> bool:
        """Whether UxAS has answered; NoPlan, or Stuck if its plan differs from the checked one."""
        response = [b for b in self.heard if type(b).__name__ == "AutomationResponse"]
        if not response:
            return False
        if not response[-1].MissionCommandList:
            raise NoPlan(tuple(pair.Value for pair in response[-1].Info) or ("UxAS has none",))
        summary = [b for b in self.heard if type(b).__name__ == "TaskAssignmentSummary"]
        wrong = agrees(self.plan, summary[-1]) if summary else "it has told no assignment"
        if wrong:
            raise Stuck(f"UxAS has planned otherwise than the plan that was checked: {wrong}")
        return True

    def _all_commanded(self) -> bool:
        return {item.vehicle_id for item in self.plan.items} <= self.commanded

    def _control(self, state: str, rate: float) -> None:
        body = lmcp.new("SessionStatus", State=state, RealTimeMultiple=rate)
        assert self.simulator is not None
        payload = wire.enclose(body.all_names[0], lmcp.binary.pack(body)).pack()
        self.simulator.send((payload,))
        self._turn()

    def _wait(self, what: str, done: Callable[[], bool]) -> None:
        """Wait for a condition; Stuck on timeout, ProcessEnded if a process ends."""
        until_s = time.monotonic() + STARTS_S
        self.how.tell(f"\rwaiting for {what}")
        while not done():
            if is_due(until_s, time.monotonic()):
                raise Stuck(f"{what} has not arrived within {STARTS_S:g} s")
            self._turn()

    # what comes -----------------------------------------------------------------------------------

    def _turn(self) -> None:
        """Process everything received, and check the processes."""
        now_s, arrived = time.monotonic(), 0
        for name, port, take in (
            (UXAS, self.uxas, self._from_uxas),
            (SIMULATOR, self.simulator, self._from_simulator),
        ):
            if port is None:
                continue
            for incoming in port.step(now_s):
                arrived += 1
                take(_body(incoming, name))
            if port.peers:
                self.stood.add(name)
            elif name in self.stood:
                self._cut(name)
        if self.how.amase is not None:
            heard, count = self.how.amase.step(now_s)
            arrived += count
            for body in heard:
                self._from_simulator(body)
        arrived += self._fail()
        if not arrived or is_due(self.look_s, now_s):
            self.look_s = now_s + LOOK_S
            self.children.watch()
        if not arrived:
            time.sleep(0.002)

    def _cut(self, name: str) -> None:
        """A connection has closed and data was lost: ProcessEnded if a process has ended, else Stuck."""
        until_s = time.monotonic() + GRACE_S
        while not is_due(until_s, time.monotonic()):
            self.children.watch()
            time.sleep(0.02)
        raise Stuck(f"the connection of the recorder to {name} has ended")

    def _from_simulator(self, body: Any) -> None:
        kind = type(body).__name__
        if kind == "MissionCommand":
            self.commanded.add(body.VehicleID)
        # states from the scenario file have no time
        if kind != "AirVehicleState" or not body.Time:
            return
        self.there.add(body.ID)
        self.recorder.state(body)
        self.news_s[SIMULATOR] = time.monotonic()

    def _from_uxas(self, body: Any) -> None:
        if not self.flown:
            self.heard.append(body)
            return
        self.ending.heard(self.recorder.heard(body))
        self.news_s[UXAS] = time.monotonic()

    # the flight -----------------------------------------------------------------------------------

    def run(self) -> Ended:
        """Fly until the flight ends (see `Ending`), or a process does."""
        outcome, why, say_ms = "", "", 0
        self.news_s = dict.fromkeys((SIMULATOR, UXAS), time.monotonic())
        try:
            while not outcome:
                self._turn()
                now_ms = self.recorder.now_ms
                if self.how.amase is not None and not self.how.amase.flies:
                    # an absent AMASE is waited for; UxAS's clock stands meanwhile
                    self.news_s = dict.fromkeys(self.news_s, time.monotonic())
                if self.ending.unheard >= set(self.mission.instances):
                    # UxAS, which reports heartbeats, has none to report
                    self.news_s[UXAS] = time.monotonic()
                for name, news_s in self.news_s.items():
                    if is_due(news_s + SILENCE_S, time.monotonic()):
                        raise Stuck(f"{name} has told nothing of the flight for {SILENCE_S:g} s")
                if is_due(say_ms, now_ms):
                    say_ms = now_ms + PROGRESS_MS
                    self.how.tell(f"\r{now_ms / 1000:7.1f} s of flight: flying")
                late = is_due(self.mission.simulation.limit_ms, now_ms)
                outcome = self.ending.outcome(now_ms, late)
            self.children.watch()  # a flight in which a process has ended is incomplete
        except (ProcessEnded, Stuck, AmaseLost) as error:
            outcome, why = "", str(error)
        # after an aborted flight no task is reported as failed
        for task in sorted(self.ending.left) if outcome else ():
            self._failed(task, outcome)
        self.recorder.end(outcome)
        pids = {name: child.pid for name, child in self.children.running.items()}
        return Ended(outcome, why, pids, self.ports._asdict())

    def _failed(self, task: int, outcome: str) -> None:
        """Record a task that UxAS has not reported as complete."""
        vehicle = next(item.vehicle_id for item in self.plan.items if item.task_id == task)
        why = self.ending.why(task, outcome, self.recorder.now_ms)
        self.recorder.failed(task, vehicle, why)

    def close(self) -> None:
        """Close the connections, and continue stopped processes so that they can end."""
        if self.stands:
            self.children.signalled("icarous_", signal.SIGCONT)
        if self.failing is not None:
            self.failing.close()
        for port in (self.uxas, self.simulator):
            if port is not None:
                port.close()


def _words(ports: Ports) -> str:
    return ", ".join(f"{name} {port}" for name, port in ports._asdict().items())


def _body(incoming: Incoming, name: str) -> Any:
    try:
        message = wire.parse(incoming.parts[0])
        return lmcp.binary.received(message.payload, message.descriptor)[0]
    except BadInput as error:
        raise Stuck(f"what {name} says cannot be read: {error}") from error
