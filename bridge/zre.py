"""A peer of ZRE (RFC 36), the protocol of Zyre: peers discover each other by UDP beacons and communicate over ZeroMQ,
one to one (whisper) or with a group (shout).

Without threads: `step` does all that is due and returns the events. A silent peer is pinged after five seconds and
dropped after thirty, as in RFC 36; one that has lost messages, speaks another version or exceeds the number of peers
is refused with a reason. Compatible with C Zyre 2.
"""

from __future__ import annotations

import uuid as uuids
from typing import Any, NamedTuple

import zmq

from cratous.bridge import zre_wire as wire
from cratous.bridge.port import Limits, Report, Tally, is_due
from cratous.bridge.zre_beacon import BEACON_PORT, Beacon
from cratous.bridge.zre_peer import IDENTITY, Event, Peer, hexadecimal
from cratous.spec.errors import BadInput

_EVASIVE_S, _EXPIRED_S = 5.0, 30.0
_BATCH = 2000


class Beacons(NamedTuple):
    """How a node announces itself: network device, UDP port, and interval [s]."""

    device: str = "lo"
    port: int = BEACON_PORT
    interval_s: float = 1.0


class ZreNode:
    """One ZRE node; see the module."""

    def __init__(
        self,
        context: zmq.Context[Any],
        name: str,
        *,
        headers: dict[str, str] | None = None,
        beacons: Beacons = Beacons(),
        limits: Limits | None = None,
        report: Report = lambda _severity, _text: None,
        where: str = "",
    ) -> None:
        """Listens, and sends beacons from the first `step` on. BadInput if the device does not exist."""
        self._context, self.name = context, name
        self._headers = dict(headers or {})
        self._limits = limits or Limits()
        self._report = report
        self._interval_s = beacons.interval_s
        self._uuid = uuids.uuid4().bytes
        self._peers: dict[bytes, Peer] = {}
        self._groups: list[str] = []
        self._status = 0
        self._beacon_s: float | None = None
        self._now_s = 0.0
        self._events: list[Event] = []
        self._closed = False
        self._tally = Tally(f"zyre {name}", report)
        self.counts = self._tally.counts
        self._beacon = Beacon(beacons.device, beacons.port, self._uuid, self._tally, where)
        self._inbox = context.socket(zmq.ROUTER)
        try:
            self._inbox.linger = 0
            self._inbox.rcvhwm = self._limits.high_water
            self._inbox.maxmsgsize = self._limits.payload_bytes + 8192
            self._inbox.router_handover = True  # a reconnecting peer takes over its identity
            port = self._inbox.bind_to_random_port(f"tcp://{self._beacon.address}")
        except zmq.ZMQError as error:
            self._beacon.close()
            self._inbox.close()
            raise BadInput(
                f"cannot listen ({error})", where=where, item="NetworkDevice", got=beacons.device
            ) from None
        self._port = int(port)

    @property
    def uuid(self) -> str:
        """This node's identifier, 32 hexadecimal digits."""
        return self._uuid.hex().upper()

    @property
    def endpoint(self) -> str:
        """The ZeroMQ address of this node's inbox."""
        return f"tcp://{self._beacon.address}:{self._port}"

    @property
    def due_s(self) -> float | None:
        """When the next beacon or ping is due [s, monotonic clock]."""
        if self._closed:
            return None
        times = [self._beacon_s or 0.0]
        for peer in self._peers.values():
            times.append(peer.seen_s + (_EXPIRED_S if peer.pinged else _EVASIVE_S))
        return min(times)

    def peers(self) -> dict[str, str]:
        """The names of the peers that have sent HELLO, by uuid."""
        return {hexadecimal(u): peer.name for u, peer in self._peers.items() if peer.ready}

    def handles(self) -> list[tuple[Any, int]]:
        """The inbox and the beacon socket to poll, each with its flags."""
        if self._closed:
            return []
        return [(self._inbox, zmq.POLLIN), (self._beacon.fileno(), zmq.POLLIN)]

    def step(self, now_s: float) -> list[Event]:
        """Send beacons and pings that are due, read what has arrived; the events in order. now_s: monotonic clock
        [s]."""
        self._now_s = now_s
        if self._closed:
            return []
        if self._beacon_s is None or is_due(self._beacon_s, now_s):
            self._beacon.shine(self._port)
            self._beacon_s = now_s + self._interval_s
        self._read_beacons()
        self._read_inbox()
        self._check_silence()
        events, self._events = self._events, []
        return events

    def join(self, group: str) -> None:
        """Join a group, and notify all peers."""
        if group not in self._groups:
            self._groups.append(group)
            self._membership(wire.JOIN, group)

    def leave(self, group: str) -> None:
        """Leave a group, and notify all peers."""
        if group in self._groups:
            self._groups.remove(group)
            self._membership(wire.LEAVE, group)

    def whisper(self, peer: str, content: tuple[bytes, ...]) -> bool:
        """Send to one peer by uuid; False (and counted) if it is unknown or does not read."""
        found = self._peers.get(bytes.fromhex(peer))
        if found is None or not found.ready:
            self._tally.lose("no such peer", peer)
            return False
        return self._send(found, wire.Command(wire.WHISPER, 0), content)

    def shout(self, group: str, content: tuple[bytes, ...]) -> int:
        """Send to all peers of a group; the number of peers reached."""
        sent = 0
        for peer in self._peers.values():
            if peer.ready and group in peer.groups:
                sent += self._send(peer, wire.Command(wire.SHOUT, 0, group=group), content)
        return sent

    def close(self) -> None:
        """Announce the departure by a beacon with port 0, then close all sockets."""
        if self._closed:
            return
        self._beacon.shine(0)
        for peer in self._peers.values():
            peer.sock.close(linger=100)
        self._peers.clear()
        self._beacon.close()
        self._inbox.close(linger=0)
        self._closed = True

    def _read_beacons(self) -> None:
        for uuid, host, port in self._beacon.read():
            if port == 0:
                self._remove(uuid, "it has left")
            else:
                peer = self._require(uuid, f"tcp://{host}:{port}")
                if peer is not None:
                    self._refresh(peer)

    def _require(self, uuid: bytes, endpoint: str) -> Peer | None:
        """The peer with this uuid; a new one is connected to and greeted."""
        peer = self._peers.get(uuid)
        if peer is not None:
            return peer
        if len(self._peers) >= self._limits.connections:
            self._tally.refuse("too many peers", f"{endpoint}; {len(self._peers)} are known")
            return None
        try:
            peer = Peer.connect(self._context, self._uuid, endpoint, self._limits.high_water)
        except zmq.ZMQError as error:
            self._tally.refuse("endpoint that cannot be used", f"{endpoint} ({error})")
            return None
        peer.seen_s = self._now_s
        self._peers[uuid] = peer
        self._send(
            peer,
            wire.Command(
                wire.HELLO,
                0,
                endpoint=self.endpoint,
                groups=tuple(self._groups),
                status=self._status,
                name=self.name,
                headers=self._headers,
            ),
        )
        return peer

    def _send(self, peer: Peer, command: wire.Command, content: tuple[bytes, ...] = ()) -> bool:
        try:
            peer.send(command, content)
        except zmq.Again:
            self._tally.lose("peer does not read", f"{peer.name or peer.endpoint}")
            return False
        if command.number in (wire.WHISPER, wire.SHOUT):
            self.counts.sent += 1
        return True

    def _read_inbox(self) -> None:
        for _ in range(_BATCH):
            try:
                identity, *frames = self._inbox.recv_multipart(zmq.NOBLOCK)
            except zmq.Again:
                return
            if len(identity) != 17 or identity[:1] != IDENTITY or not frames:
                self._tally.refuse("not a ZRE peer", identity.hex())
                continue
            uuid = identity[1:]
            try:
                command = wire.unpack(frames[0])
                self._command(uuid, command, tuple(frames[1:]))
            except BadInput as error:
                self._tally.refuse(error.what, f"{hexadecimal(uuid)}: {error}")
                if error.what == "other version of ZRE":
                    self._remove(uuid, str(error))

    def _command(self, uuid: bytes, command: wire.Command, content: tuple[bytes, ...]) -> None:
        peer = self._peers.get(uuid)
        if command.number == wire.HELLO:
            if peer is not None and peer.ready:  # it has restarted
                self._remove(uuid, "it says hello again")
            if not command.endpoint.startswith("tcp://"):
                raise BadInput("endpoint that cannot be used", got=command.endpoint)
            peer = self._require(uuid, command.endpoint)
            if peer is None:
                return
            peer.ready, peer.wanted = True, command.sequence
            peer.name, peer.headers = command.name, dict(command.headers)
            self._events.append(peer.event("ENTER", uuid))
            for group in command.groups:
                peer.groups.add(group)
                self._events.append(peer.event("JOIN", uuid, group))
            self._refresh(peer)
            return
        if peer is None or not peer.ready:
            raise BadInput("no hello yet", expected="HELLO first", got=f"command {command.number}")
        peer.wanted = (peer.wanted + 1) & 0xFFFF
        if command.sequence != peer.wanted:
            self._tally.refuse(
                "messages of a peer are lost",
                f"{peer.name}: expected {peer.wanted}, got {command.sequence}",
            )
            self._remove(uuid, "messages of it are lost")
            return
        self._refresh(peer)
        number, group = command.number, command.group
        if number == wire.WHISPER:
            self.counts.received += 1
            self._events.append(peer.event("WHISPER", uuid, content=content))
        elif number == wire.SHOUT:
            self.counts.received += 1
            self._events.append(peer.event("SHOUT", uuid, group, content))
        elif number == wire.JOIN:
            peer.groups.add(group)
            self._events.append(peer.event("JOIN", uuid, group))
        elif number == wire.LEAVE:
            peer.groups.discard(group)
            self._events.append(peer.event("LEAVE", uuid, group))
        elif number == wire.PING:
            self._send(peer, wire.Command(wire.PING_OK, 0))
        elif number == wire.GOODBYE:
            self._remove(uuid, "it has left")

    def _membership(self, number: int, group: str) -> None:
        self._status = (self._status + 1) & 0xFF
        for peer in self._peers.values():
            self._send(peer, wire.Command(number, 0, group=group, status=self._status))

    def _refresh(self, peer: Peer) -> None:
        peer.seen_s, peer.pinged = self._now_s, False

    def _check_silence(self) -> None:
        for uuid, peer in list(self._peers.items()):
            silent = self._now_s - peer.seen_s
            if silent >= _EXPIRED_S:
                self._remove(uuid, f"silent for {_EXPIRED_S:g} s")
            elif silent >= _EVASIVE_S and not peer.pinged:
                peer.pinged = True
                if peer.ready:
                    self._send(peer, wire.Command(wire.PING, 0))

    def _remove(self, uuid: bytes, why: str) -> None:
        peer = self._peers.pop(uuid, None)
        if peer is None:
            return
        peer.sock.close(linger=0)
        if peer.ready:
            self._events.append(peer.event("EXIT", uuid))
            self._report("INFO", f"zyre {self.name}: {peer.name} is gone ({why})")
