"""The simulator's port: the functions of AMASE's TCP server, without its faults.

Everything published goes to every client; a client's message is processed and relayed to the others. A client
that does not read loses its oldest messages and delays nobody. SessionStatus controls the clock: Paused,
Running (with its RealTimeMultiple, if that is above 0), Reset, Stopped. Late clients receive the
configurations of all vehicles, which AMASE omits. With `only`, no further clients are accepted after that
many, not even to replace one that leaves: without that one the flight is pointless.

A vehicle may have a port of its own, as in AMASE: its clients receive its configuration, its states, its
VehicleActionCommands and the weather, and send the same as other clients. In compatibility mode events at
time 0 are processed on creation, as AMASE does on loading: before any client is connected.
"""

from __future__ import annotations

import select
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.port import Address, Incoming, Limits, Tally
from cratous.bridge.tcp_port import TcpPort
from cratous.services.simulator.driver import STATES
from cratous.services.simulator.world import TICK_S, World
from cratous.spec.errors import BadInput, CratousError

LIMITS = Limits(payload_bytes=4 << 20, waiting_bytes=1 << 20, connections=100)
BURST = 500
"""Most ticks in a row before clients are served again."""
MOST_RATE = 1e6
CONFIGURATIONS = ("AirVehicleConfiguration", *STATES)
TOLD_OF = ("AirVehicleState", *STATES.values())
"""Configurations of vehicles, and their states."""
LINGER_S = 2.0
"""Time for clients to read pending data at the end [s]."""


class ClientGone(CratousError):
    """A required client of the simulator has disconnected before the end."""

    exit_code = 3


class Server:
    """A world that clients observe and command; see the module.

    make: creates the world, also for Reset. rate: multiple of real time. clients: number required before it
    begins. only: most clients ever accepted, 0: no limit. stopping: set to end.
    """

    def __init__(
        self,
        make: Callable[[], World],
        where: Address,
        report: Callable[[str, str], None],
        *,
        rate: float = 1.0,
        clients: int = 0,
        only: int = 0,
        vehicles: Mapping[int, Address] | None = None,
    ) -> None:
        self._make = make
        self.rate = rate
        self._clients = clients
        self._only, self._shut = only, False
        limits = replace(LIMITS, connections=only or LIMITS.connections)
        self.port = TcpPort(where, server=True, limits=limits, report=report)
        self.vehicle_ports: dict[int, TcpPort] = {}
        try:
            for key, place in (vehicles or {}).items():
                self.vehicle_ports[key] = TcpPort(place, server=True, limits=LIMITS, report=report)
        except BadInput:
            self._close()
            raise
        self._tally = Tally("clients", report)
        self._report = report
        self.state = "Running"
        self.stopping = False
        self._known: dict[int, Any] = {}
        self._peers = 0
        self._peers_of: dict[int, int] = {}
        self._behind_s = 0.0
        try:
            self.world = self._begun()
        except BadInput:
            self._close()
            raise

    @property
    def refused(self) -> dict[str, int]:
        """Number of rejected client messages, by reason."""
        return dict(self._tally.counts.refused)

    def run(self) -> None:
        """Run until the scenario is over, or `stopping`; then close the port. ClientGone: see `only`."""
        last_s = time.monotonic()
        try:
            while not (self.stopping or self.world.over or self.state == "Stopped"):
                now_s = time.monotonic()
                self.turn(now_s, now_s - last_s)
                last_s = now_s
            self.tell(self.world.status("Stopped", self.rate))
            self._linger()
        finally:
            self._close()

    def _begun(self) -> World:
        """A new world; in compatibility mode the events at time 0 have already taken place."""
        world = self._make()
        if world.compatible:
            for body in world.begin():
                self.tell(body)
        return world

    def _ports(self) -> list[TcpPort]:
        return [self.port, *self.vehicle_ports.values()]

    def _close(self) -> None:
        for port in self._ports():
            port.close()

    def turn(self, now_s: float, passed_s: float) -> None:
        """Serve the clients, then advance by the elapsed time [s]; waits if nothing is due."""
        for port in self._ports():
            for incoming in port.step(now_s):
                self._take(incoming, port)
        self._tell_newcomers()
        self._count()
        for text in self.world.warnings():
            self._report("WARN", text)
        there = sum(port.peers for port in self._ports())
        self._clients = max(0, self._clients if there < self._clients else 0)
        if self.state != "Running" or self._clients:
            self._behind_s = 0.0
            self._wait(0.05)
            return
        self._behind_s += passed_s * self.rate
        for _ in range(BURST):
            if self._behind_s < TICK_S or self.world.over:
                break
            self._behind_s -= TICK_S
            for body in self.world.tick():
                self.tell(body)
        else:
            # time that cannot be caught up is dropped: the machine limits the rate
            self._behind_s = min(self._behind_s, BURST * TICK_S)
            return
        self._wait(max(0.0, (TICK_S - self._behind_s) / self.rate))

    def _tell_newcomers(self) -> None:
        if self.port.peers > self._peers:
            for body in self._known.values():
                self.port.send((frame_payload(body),))
        self._peers = self.port.peers
        for key, port in self.vehicle_ports.items():
            if port.peers > self._peers_of.get(key, 0) and key in self._known:
                port.send((frame_payload(self._known[key]),))
            self._peers_of[key] = port.peers

    def _count(self) -> None:
        """Stop accepting after the last of the `only` clients; ClientGone if one of them has left and no end
        was requested.
        """
        if not self._only or self.stopping or self.state == "Stopped":
            return
        if self._peers == self._only:
            self.port.shut()
            self._shut = True
        elif self._shut:
            raise ClientGone(f"{self._peers} of the {self._only} clients are left")

    def _wait(self, most_s: float) -> None:
        handles = [handle for port in self._ports() for handle, _ in port.handles()]
        select.select(handles, [], [], min(most_s, 0.05))

    def _linger(self) -> None:
        end_s = time.monotonic() + LINGER_S
        while time.monotonic() < end_s and not self.stopping:
            if not any(port.waiting for port in self._ports()):
                break
            for port in self._ports():
                port.step(time.monotonic())
            time.sleep(0.005)

    def tell(self, body: Any, but: str = "", of: TcpPort | None = None) -> None:
        """Send an object to every client except `but`, a client of port `of`; configurations are kept for
        late clients.
        """
        name = type(body).__name__
        if name == "SessionStatus" and not but:
            body = body.copy(RealTimeMultiple=self.rate)
        elif name in CONFIGURATIONS:
            self._known[body.ID] = body
        elif name == "RemoveEntities":
            for key in body.EntityList:
                self._known.pop(key, None)
        of_vehicles = [port for key, port in self.vehicle_ports.items() if _concerns(body, key)]
        wanted = [port for port in (self.port, *of_vehicles) if port.peers]
        if wanted:
            payload = frame_payload(body)
            for port in wanted:
                # client names are unique within their port only
                port.send((payload,), but if port is of else "")

    def _take(self, incoming: Incoming, port: TcpPort) -> None:
        """Process a client's message; one that cannot be processed is reported and not forwarded."""
        try:
            message = wire.parse(incoming.parts[0])
            if message.content_type != wire.LMCP:
                raise BadInput("unknown content type", expected="lmcp", got=message.content_type)
            body, _payload, _notes = lmcp.binary.received(message.payload, message.descriptor)
            if type(body).__name__ == "SessionStatus":
                self._control(body)
                return
            self.world.receive(body, incoming.peer)
        except BadInput as error:
            self._tally.refuse("message", str(error))
            return
        self.tell(body, incoming.peer, port)

    def _control(self, body: Any) -> None:
        wanted = body.State.name
        if 0 < body.RealTimeMultiple <= MOST_RATE:
            self.rate = body.RealTimeMultiple
        if wanted == "Reset":
            self.world = self._begun()
            wanted = "Paused"
        self.state = wanted
        self._report("INFO", f"a client asks: {body.State.name}, {self.rate:g} times real time")
        self.tell(self.world.status(wanted))


def _concerns(body: Any, vehicle: int) -> bool:
    """Whether an object is sent on a vehicle's own port."""
    kind = type(body).__name__
    if kind in CONFIGURATIONS or kind in TOLD_OF:
        return bool(vehicle == body.ID)
    if kind == "VehicleActionCommand":
        return bool(body.VehicleID == vehicle)
    return kind == "WeatherReport"


def frame_payload(body: Any) -> bytes:
    """An object as AMASE sends it: its address, with entity and service 0."""
    return wire.enclose(body.all_names[0], lmcp.binary.pack(body)).pack()
