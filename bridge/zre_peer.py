"""What a ZRE node knows of its peers, and the events that it reports about them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import zmq

from cratous.bridge import zre_wire as wire

IDENTITY = b"\x01"  # precedes the uuid in the identity of a peer's socket


@dataclass(frozen=True)
class Event:
    """An event of a peer: ENTER, EXIT, JOIN, LEAVE, WHISPER or SHOUT."""

    kind: str
    peer: str
    name: str
    group: str = ""
    headers: dict[str, str] = field(default_factory=dict)
    content: tuple[bytes, ...] = ()
    address: str = ""


@dataclass
class Peer:
    """The state of another node, and the socket to it."""

    sock: Any
    endpoint: str
    name: str = ""
    ready: bool = False  # its HELLO has been received
    sent: int = 0
    wanted: int = 0
    seen_s: float = 0.0
    pinged: bool = False
    groups: set[str] = field(default_factory=set)
    headers: dict[str, str] = field(default_factory=dict)

    @staticmethod
    def connect(context: zmq.Context[Any], uuid: bytes, endpoint: str, high_water: int) -> Peer:
        """A new peer, before HELLO is sent; uuid: our own. zmq.ZMQError for an address that cannot be used."""
        sock = context.socket(zmq.DEALER)
        sock.linger = 0
        sock.identity = IDENTITY + uuid
        sock.sndhwm = high_water
        try:
            sock.connect(endpoint)
        except zmq.ZMQError:
            sock.close()
            raise
        return Peer(sock, endpoint)

    def send(self, command: wire.Command, content: tuple[bytes, ...] = ()) -> None:
        """Send a command with the next sequence number; zmq.Again if the peer's queue is full."""
        sequence = (self.sent + 1) & 0xFFFF
        frame = wire.pack(replace(command, sequence=sequence))
        self.sock.send_multipart((frame, *content), zmq.NOBLOCK)
        self.sent = sequence

    def event(
        self, kind: str, uuid: bytes, group: str = "", content: tuple[bytes, ...] = ()
    ) -> Event:
        """An event of this peer."""
        headers = dict(self.headers) if kind == "ENTER" else {}
        return Event(kind, hexadecimal(uuid), self.name, group, headers, content, self.endpoint)


def hexadecimal(uuid: bytes) -> str:
    """A uuid of 16 bytes as 32 hexadecimal digits, as Zyre writes it."""
    return uuid.hex().upper()
