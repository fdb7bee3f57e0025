"""A bridge with injected faults for a flight in processes: between each ICAROUS and UxAS, in flight time.

Each ICAROUS connects here; its and UxAS's v2 packets are forwarded one by one, with the same faults as in a
single process (`bridge.faults`); forged modes are made without a key (`forging`). The handshake is not
affected. A peer that does not accept data in time loses its connection.
"""

from __future__ import annotations

import random
import socket
from collections.abc import Sequence
from contextlib import suppress

from cratous.bridge.faults import FailingWay
from cratous.bridge.text_protocol import Direction
from cratous.core.authority.timeliness import lasted
from cratous.services.processes.forging import Forger
from cratous.spec.mission.bridge_faults import BridgeFaults

HOST = "127.0.0.1"
READ = 65536
MOST_UNSENT = 1 << 20
"""Most unsent bytes of a peer."""
GREETING = {Direction.DOWN: 2, Direction.UP: 1}
"""Number of v2 handshake lines in each direction."""


class _Half:
    """One direction of a connection, from one socket to the other."""

    def __init__(self, way: FailingWay, direction: Direction, forger: Forger) -> None:
        self.way, self._forger, self._up = way, forger, direction is Direction.UP
        self._greeting = GREETING[direction]
        self._part, self.unsent = b"", b""

    def come(self, data: bytes, now_ms: int) -> None:
        """Process received bytes: handshake lines are forwarded unchanged, then each packet separately."""
        *lines, self._part = (self._part + data).split(b"\n")
        for line in lines:
            if self._greeting:
                self._greeting -= 1
                self.unsent += line + b"\n"
            else:
                self._forger.hears(line + b"\n", self._up)
                self.way.take(line + b"\n", now_ms)
        if len(self._part) > READ:  # longer than any line of the protocol
            self.way.take(self._part, now_ms)
            self._part = b""

    def forge(self) -> None:
        """Send the forged mode line that is due, if there is one."""
        line = self.way.forged()
        if line and not self._greeting:
            self.unsent += self._forger.packet(line)


class _Connection:
    """The connection of an ICAROUS, and the one to UxAS opened for it."""

    def __init__(
        self,
        near: socket.socket,
        far: socket.socket,
        ways: dict[Direction, FailingWay],
        forger: Forger,
    ) -> None:
        self.open = True
        for way in ways.values():
            way.clear()
        down, up = (_Half(ways[one], one, forger) for one in (Direction.DOWN, Direction.UP))
        self._halves = ((far, down, near), (near, up, far))
        for one in (near, far):
            one.setblocking(False)
            one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def step(self, now_ms: int, forges: bool) -> int:
        """Forward what has arrived and is due. Returns the number of bytes received. forges: an exchange is
        due.
        """
        count = 0
        for source, half, sink in self._halves:
            with suppress(BlockingIOError):
                data = self._read(source)
                count += len(data)
                half.come(data, now_ms)
            if forges and half is self._halves[1][1]:
                half.forge()
            if half.way.breaks(now_ms):
                self.open = False
            half.unsent += b"".join(half.way.due(now_ms))
            with suppress(BlockingIOError):
                half.unsent = half.unsent[self._write(sink, half.unsent) :]
            if len(half.unsent) > MOST_UNSENT:
                self.open = False
        if not self.open:
            self.close()
        return count

    def _read(self, source: socket.socket) -> bytes:
        try:
            data = source.recv(READ)
        except ConnectionError:
            data = b""
        self.open &= bool(data)
        return data

    def _write(self, sink: socket.socket, data: bytes) -> int:
        try:
            return sink.send(data) if data else 0
        except ConnectionError:
            self.open = False
            return 0

    def close(self) -> None:
        """Close both sides."""
        self.open = False
        for source, _, _ in self._halves:
            source.close()


class FailingBridge:
    """Listens for each vehicle's ICAROUS at `ports` and forwards to UxAS; call `step` regularly."""

    def __init__(self, faults: BridgeFaults, vehicles: Sequence[int], heartbeat_ms: int) -> None:
        """heartbeat_ms: of the mission; there are two exchanges in each."""
        self._faults, self._exchange_ms = faults, heartbeat_ms // 2
        self._far = (HOST, 0)
        self._listeners = {vid: socket.create_server((HOST, 0)) for vid in vehicles}
        self._ways = {
            vid: {one: FailingWay(faults, vid, one) for one in Direction} for vid in vehicles
        }
        self._connections: dict[int, _Connection] = {}
        self._exchanged_ms = self._opened_count = 0
        for listener in self._listeners.values():
            listener.setblocking(False)

    @property
    def ports(self) -> dict[int, int]:
        """The TCP port by vehicle to which its ICAROUS connects."""
        return {vid: one.getsockname()[1] for vid, one in self._listeners.items()}

    def leads_to(self, port: int) -> None:
        """Set the TCP port on which UxAS listens."""
        self._far = (HOST, port)

    def step(self, now_ms: int, flies: bool = True) -> int:
        """Forward what has arrived; returns the number of bytes. now_ms: flight time; flies: whether the
        clock runs.

        Before it runs no connection is cut: the clock waits for all processes to connect.
        """
        broken = flies and self._faults.is_cut(now_ms)
        for vid, listener in self._listeners.items():
            with suppress(BlockingIOError):
                near, _ = listener.accept()
                self._opened(vid, near, broken)
        forges = lasted(self._exchanged_ms, now_ms, self._exchange_ms)
        if forges:
            self._exchanged_ms = now_ms
        count = 0
        for vid, connection in list(self._connections.items()):
            if broken:
                connection.close()
            else:
                count += connection.step(now_ms, forges)
            if not connection.open:
                del self._connections[vid]
        return count

    def _opened(self, vid: int, near: socket.socket, broken: bool) -> None:
        if vid in self._connections or broken:
            near.close()
            return
        try:
            far = socket.create_connection(self._far, timeout=5.0)
        except OSError:  # UxAS is not listening yet: the peer retries
            near.close()
            return
        draw = random.Random(f"{self._faults.seed} {vid} forger {self._opened_count}")
        self._opened_count += 1
        self._connections[vid] = _Connection(near, far, self._ways[vid], Forger(vid, draw))

    def close(self) -> None:
        """Close all connections and listeners."""
        for connection in self._connections.values():
            connection.close()
        for listener in self._listeners.values():
            listener.close()
