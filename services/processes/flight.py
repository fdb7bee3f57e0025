"""The flight in processes: starts them in order, lets the clock go, watches, and ends them all.

Nothing flies before UxAS has made the plan that was checked and the simulator has its commands: the
simulator's clock stands from its first states until then.
"""

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
from cratous.spec.mission.plan import Plan, in_part_of

Tell = Callable[[str], None]
SIMULATOR, UXAS = "simulator", "uxas"
STARTS_S = 600.0
"""How long the start of all processes may take [s]; all of them check the proofs first."""
SILENCE_S = 60.0
"""A simulator that tells no state for so long [s] while its clock runs is taken to be stuck; and UxAS, which tells
each heartbeat of an ICAROUS instance, if it says nothing."""
PROGRESS_MS = 10_000
LIMITS = Limits(waiting_bytes=64 << 20)
LOOK_S = 0.2
"""However much comes, the processes are looked at so often [s]."""


class Stuck(CratousError):
    """A process runs, but what has to come from it does not."""

    exit_code = 3


class Flying(NamedTuple):
    """How a flight in processes is set up. path: of the mission, for ICAROUS; digest: of that mission, the
    hash of its report; folder: for what they are given and what they say; rate: times real time; original: ICAROUS is behind
    clients of the original's, which others start; amase: what flies in place of our simulator; direct: links of ICAROUS."""

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
    """outcome: of the mission, empty if that is not known; why: what went wrong; pids and ports, by name."""

    outcome: str
    why: str
    pids: dict[str, int]
    ports: dict[str, int]


def fly(mission: Mission, plan: Plan, told: Told, recorder: Recorder, how: Flying) -> Ended:
    """Fly a plan in processes of their own and record it; see the module.

    ProcessEnded, Stuck or NoPlan if it does not come to a flight; what happens later is in the answer.
    """
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
    """The processes, the two connections of the recorder, and what has come over them."""

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
        self.complete: set[int] = set()
        self.failed: dict[int, str] = {}
        self.away: set[int] = set()
        self.news_s: dict[str, float] = {}
        self.look_s = 0.0
        self.stood: set[str] = set()
        self.failing: FailingBridge | None = None
        self.stands = False
        # of this flight alone, and of each ICAROUS its own: a stranger cannot be one of them, nor one another
        self.keys = Keys({}) if how.original else new_keys(mission.instances)

    # the start ------------------------------------------------------------------------------------

    def start(self) -> None:
        """All processes, in order; then the plan is made, checked, commanded, and the clock runs."""
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
        # UxAS waits for its ICAROUS instances before it sends anything: nothing goes by unheard
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
        """By vehicle, the port at which its ICAROUS finds UxAS: through a bridge that fails, if that is asked for."""
        simulation = self.mission.simulation
        if not isinstance(simulation, FaultySimulation):
            return dict.fromkeys(instances, self.ports.icarous)
        faults = simulation.bridge_faults
        self.failing = FailingBridge(faults, instances, simulation.heartbeat_ms)
        self.failing.leads_to(self.ports.icarous)
        return self.failing.ports

    def _fail(self) -> int:
        """What goes over a bridge that fails, and whether ICAROUS stands still now; how many bytes went."""
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
        """Whether UxAS has answered; NoPlan or Stuck if it does not fly the plan that was checked."""
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
        """Until something is so; Stuck if that takes too long, ProcessEnded if one of them ends."""
        until_s = time.monotonic() + STARTS_S
        self.how.tell(f"\rwaiting for {what}")
        while not done():
            if is_due(until_s, time.monotonic()):
                raise Stuck(f"{what} has not arrived within {STARTS_S:g} s")
            self._turn()

    # what comes -----------------------------------------------------------------------------------

    def _turn(self) -> None:
        """Everything that has come, and a look at the processes."""
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
        """A connection has ended, and what was said meanwhile is lost: ProcessEnded if that is why, or Stuck."""
        until_s = time.monotonic() + GRACE_S
        while not is_due(until_s, time.monotonic()):
            self.children.watch()
            time.sleep(0.02)
        raise Stuck(f"the connection of the recorder to {name} has ended")

    def _from_simulator(self, body: Any) -> None:
        kind = type(body).__name__
        if kind == "MissionCommand":
            self.commanded.add(body.VehicleID)
        # the scenario's own states, which are told as well, bear no time
        if kind != "AirVehicleState" or not body.Time:
            return
        self.there.add(body.ID)
        self.recorder.state(body)
        self.news_s[SIMULATOR] = time.monotonic()

    def _from_uxas(self, body: Any) -> None:
        if not self.flown:
            self.heard.append(body)
            return
        self.recorder.heard(body)
        self.news_s[UXAS] = time.monotonic()
        kind = type(body).__name__
        if kind == "TaskComplete":
            self.complete.add(body.TaskID)
        elif kind == "AuthorityChange":
            {"ICAROUS": self.away.add, "UxAS": self.away.discard}[body.Owner.name](body.VehicleID)
        elif kind == "ServiceStatus":
            said = {pair.Key: pair.Value for pair in body.Info}
            if said.get("TaskID", "").isdigit():
                self.failed[int(said["TaskID"])] = said.get("reason", "it ends undone")

    # the flight -----------------------------------------------------------------------------------

    def run(self) -> Ended:
        """Until UxAS says that all tasks have ended, or the limit, or a process ends."""
        asked = {item.task_id for item in self.plan.items}
        outcome, why, say_ms = "", "", 0
        self.news_s = dict.fromkeys((SIMULATOR, UXAS), time.monotonic())
        try:
            while not outcome:
                self._turn()
                now_ms = self.recorder.now_ms
                if self.how.amase is not None and not self.how.amase.flies:
                    # it is waited for, so long as it may be away; UxAS's clock stands meanwhile
                    self.news_s = dict.fromkeys(self.news_s, time.monotonic())
                for name, news_s in self.news_s.items():
                    if is_due(news_s + SILENCE_S, time.monotonic()):
                        raise Stuck(f"{name} has told nothing of the flight for {SILENCE_S:g} s")
                if is_due(say_ms, now_ms):
                    say_ms = now_ms + PROGRESS_MS
                    self.how.tell(f"\r{now_ms / 1000:7.1f} s of flight: flying")
                outcome = self._outcome(asked, is_due(self.mission.simulation.limit_ms, now_ms))
            self.children.watch()  # a flight of which a process has ended meanwhile is not whole
        except (ProcessEnded, Stuck, AmaseLost) as error:
            outcome, why = "", str(error)
        # of a flight that was cut off nothing is said that nobody has seen
        for task in sorted(asked - self.complete) if outcome else ():
            self._failed(task, outcome)
        self.recorder.end(outcome)
        pids = {name: child.pid for name, child in self.children.running.items()}
        return Ended(outcome, why, pids, self.ports._asdict())

    def _outcome(self, asked: set[int], late: bool) -> str:
        """How the mission has ended, empty while it has not."""
        left = asked - self.complete
        if left <= self.failed.keys() and not self.away:
            in_part = asked & {one.task_id for one in in_part_of(self.plan)}
            return "failed" if left or in_part else "complete"
        return "limit" if late else ""

    def _failed(self, task: int, why: str) -> None:
        """A task that UxAS has not said to be complete."""
        vehicle = next(item.vehicle_id for item in self.plan.items if item.task_id == task)
        text = f"not served when the flight ended ({why})"
        self.recorder.failed(task, vehicle, self.failed.get(task, text))

    def close(self) -> None:
        """Let go of the connections, and of who was made to stand still: it has to end."""
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
