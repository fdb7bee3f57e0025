"""The CRATOUS text protocol over TCP between processes: one end that listens, one that connects.

Either of UxAS's end, which speaks first, and ICAROUS's may be the one that listens.
Nothing here blocks, but for the look-up of a host's name, and nothing raises because of a peer: what it sends
is a record (a message, a refused or skipped line), its end is a `LinkEvent`. A peer that does not finish the
handshake, sends faster than it may, sends nothing but what cannot be read, or falls silent, is dropped with
the reason.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any, NamedTuple

import zmq

from cratous.bridge.link import Link, LinkEvent, Listener, connect_later
from cratous.bridge.port import Address, Report, Tally, is_due
from cratous.bridge.text_protocol.format import encode
from cratous.bridge.text_protocol.handshake import (
    DEFAULT_SECRET,
    ClientHandshake,
    Handshake,
    ServerHandshake,
)
from cratous.bridge.text_protocol.keys import Keys
from cratous.bridge.text_protocol.layouts import ORIGINAL_LIMITS, Limits
from cratous.bridge.text_protocol.messages import (
    Direction,
    FenceVertex,
    Heartbeat,
    Hello,
    LinesMissing,
    Message,
    NotKnown,
)
from cratous.bridge.text_protocol.parser import Record, StreamParser, WireError
from cratous.bridge.text_protocol.sealed import (
    MOST_UNACKNOWLEDGED,
    Seal,
    SealedClient,
    SealedHandshake,
    SealedServer,
)
from cratous.spec.errors import BadInput

OURS = (Hello, Heartbeat, LinesMissing, NotKnown)
"""What a peer of the original's is not sent."""
PROGRAM_LIMITS = Limits(10_000, 1000, 1000, 9999, 9999)
"""The largest counts that the two programs take; a vehicle's memory is bounded by them."""
_READS = 16
PATIENCE_S = 1.0
"""So long a connection that has not shaken hands keeps its place where others wait for one [s]."""
NOISE, SILENT, LATE, FAST, NOBODY, DEAF = (
    "nothing but what cannot be read",
    "silent",
    "handshake not finished in time",
    "sends faster than it may",
    "nobody listens there",
    "does not acknowledge what it is sent",
)


@dataclass(frozen=True)
class Bounds:
    """What a peer may cost.

    handshake_s: until it has shaken hands; silence_s: until it says something, None: for ever;
    bytes_per_s, burst_bytes: how fast it may send in the long run, and at once; bad_lines: how many
    lines in a row may be unreadable; connections: how many peers at once.
    """

    handshake_s: float = 10.0
    silence_s: float | None = 300.0
    bytes_per_s: float = 1 << 20
    burst_bytes: float = 8 << 20
    bad_lines: int = 1000
    connections: int = 64


class Opened(NamedTuple):
    """Hands are shaken: messages may follow."""

    peer: str


class Came(NamedTuple):
    """What a connection has brought: that it is open, a record, or its end; the end comes last."""

    key: int
    what: Opened | Record | LinkEvent


class Connection:
    """One peer: its socket, handshake and parser, and what it has cost so far."""

    def __init__(
        self, link: Link, handshake: Handshake, direction: Direction, bounds: Bounds, now_s: float
    ) -> None:
        """direction: of what comes in. now_s: a clock that does not go back."""
        self.link, self._handshake, self._bounds = link, handshake, bounds
        self._parser = StreamParser(direction, limits=PROGRAM_LIMITS, original_peer=True)
        self._direction, self.name = direction, link.remote_name
        self._until_s: float | None = now_s + bounds.handshake_s
        self.begun_s, self.opened = now_s, False
        self._room, self._at_s, self._bad = bounds.burst_bytes, now_s, 0
        self.link.send(handshake.start())

    @property
    def seal(self) -> Seal | None:
        """Of the dialect v2, once hands are shaken."""
        return self._handshake.seal if isinstance(self._handshake, SealedHandshake) else None

    def send(self, line: bytes, now_s: float) -> bool:
        """Queue a line; False if the peer is gone."""
        if not isinstance(self._handshake, SealedHandshake):
            return self.link.send(line)
        seal = self.seal
        if seal is None:
            return False  # nothing goes before hands are shaken
        if seal.unacknowledged not in range(MOST_UNACKNOWLEDGED):
            self.drop(DEAF)
            return False
        return self.link.send(seal.wrap(line, round(1000 * now_s)))

    @property
    def due_s(self) -> float | None:
        """When it is dropped unless something comes."""
        return self._until_s

    def step(self, now_s: float) -> list[Opened | Record | LinkEvent]:
        """Move bytes; what has come, in order."""
        self.link.flush()
        self.link.drain(_READS)
        data = self.link.take()
        if not self.opened and self.link.itself:
            self.drop(NOBODY)
            data = b""
        found = self._read(data) if data else []
        self._spend(len(data), now_s)
        if data and self._handshake.done:
            silence_s = self._bounds.silence_s
            self._until_s = None if silence_s is None else now_s + silence_s
        if is_due(self._until_s, now_s):
            self.drop(SILENT if self._handshake.done else LATE)
        if not self.link.alive:
            found += self._parser.finish()
            found.append(self.link.ended or LinkEvent("closed"))
        return found

    def drop(self, why: str) -> None:
        """End it; the next `step` says so."""
        if self.link.ended is None:
            self.link.flush()
            self.link.ended = LinkEvent("dropped", why)

    def _read(self, data: bytes) -> list[Opened | Record | LinkEvent]:
        found: list[Opened | Record | LinkEvent] = []
        if not self._handshake.done:
            self.link.send(self._handshake.feed(data))
            if self._handshake.failed:
                self.link.flush()  # the reason goes before an end that came with it
                self.link.ended = LinkEvent(
                    "dropped", f"handshake failed: {self._handshake.failed}"
                )
            if not self._handshake.done:
                return found
            self.opened, self.name = True, self.link.remote_name
            found.append(Opened(self.name))
            data = self._handshake.rest
            if self.seal is not None and self._direction is Direction.UP:
                found.append(Hello(self.seal.vehicle_id))
        wrong: list[Record] = []
        if self.seal is not None:
            data, refused = self.seal.feed(data)
            wrong.extend(refused)
        for record in [*self._parser.feed(data), *wrong]:
            if self.seal is not None and isinstance(record, Hello):
                if record.vehicle_id != self.seal.vehicle_id:
                    self.drop(
                        f"HELLO of vehicle {record.vehicle_id} by {self.seal.vehicle_id}'s key"
                    )
                    break
                continue
            found.append(record)
            self._bad = self._bad + 1 if isinstance(record, WireError) else 0
            if self._bad > self._bounds.bad_lines:
                self.drop(NOISE)
                break
        return found

    def _spend(self, count: int, now_s: float) -> None:
        bounds = self._bounds
        more = (now_s - self._at_s) * bounds.bytes_per_s
        self._room = min(bounds.burst_bytes, self._room + more) - count
        self._at_s = now_s
        if self._room < 0:
            self.drop(FAST)


class TextPort:
    """The connections of one end; a port for the loop of a program (`handles`, `due_s`, `step`)."""

    def __init__(
        self,
        where: Address,
        *,
        server: bool,
        listens: bool | None = None,
        bounds: Bounds | None = None,
        original: bool = False,
        secret: str | Keys = DEFAULT_SECRET,
        report: Report = lambda _severity, _text: None,
    ) -> None:
        """server: UxAS's end, which speaks first; else ICAROUS's. listens: it waits for peers (BadInput
        if it cannot listen), else it connects, see `dial`; as in the original, UxAS's end waits.

        original: the peers are the original's: no HELLO and HBEAT, its number formats, no count above
        what its arrays hold. secret: of the compatible handshake; keys make the dialect v2.
        """
        self.where, self._server, self._original = where, server, original
        self._bounds, self._secret, self._report = bounds or Bounds(), secret, report
        self._tally = Tally(where.text, report)
        self.counts = self._tally.counts
        self._connections: dict[int, Connection] = {}
        self._keys = itertools.count(1)
        self._listener: Listener | None = None
        self._closed, self._now_s = False, 0.0
        if server if listens is None else listens:
            host = "0.0.0.0" if where.everywhere else where.host
            self._listener = Listener(host, where.port)

    @property
    def listens(self) -> bool:
        """True if it waits for its peers."""
        return self._listener is not None

    @property
    def bound(self) -> tuple[str, int]:
        """Host and port on which it listens."""
        assert self._listener is not None
        return self._listener.address

    @property
    def due_s(self) -> float | None:
        """When `step` has something to do even if nothing arrives."""
        times = [c.due_s for c in self._connections.values() if c.due_s is not None]
        return min(times, default=None)

    def handles(self) -> list[tuple[Any, int]]:
        """Sockets to poll, with what for."""
        found: list[tuple[Any, int]] = []
        if self._listener is not None and not self._closed:
            found.append((self._listener.fileno(), zmq.POLLIN))
        for one in self._connections.values():
            if one.link.alive:
                flags = zmq.POLLIN | (zmq.POLLOUT if one.link.waiting else 0)
                found.append((one.link.fileno(), flags))
        return found

    def dial(self, now_s: float, where: Address | None = None) -> int:
        """Connect to an end that listens, `self.where` if none is said; the connection's key.

        It waits for the look-up of a name alone: that nobody is there is the connection's `LinkEvent`.
        """
        where = where or self.where
        return self._join(connect_later((where.host, where.port)), now_s)

    def step(self, now_s: float) -> list[Came]:
        """Accept, read, write; what has come, connection by connection, in order of arrival."""
        if self._closed:
            return []
        self._now_s = now_s
        self._accept(now_s)
        found: list[Came] = []
        for key, one in list(self._connections.items()):
            records = one.step(now_s)
            found += [Came(key, record) for record in records]
            self.counts.received += sum(isinstance(record, Message) for record in records)
            for record in records:
                if isinstance(record, WireError):
                    self._tally.refuse(record.what, f"{one.name}: {record}")
            if not one.link.alive:
                one.link.close()
                del self._connections[key]
        return found

    def send(self, key: int, message: Message) -> bool:
        """Queue a message for a peer; False if it is gone or the message cannot stand on the wire."""
        one = self._connections.get(key)
        if one is None:
            return False
        if self._original and isinstance(message, OURS):
            return True
        # the original writes fences in a form of which its own client misreads those of ten vertices
        original = self._original and not isinstance(message, FenceVertex)
        limits = ORIGINAL_LIMITS if self._original else PROGRAM_LIMITS
        try:
            data = encode(message, original=original, limits=limits)
        except BadInput as error:
            self._tally.lose("message has no form on the wire", str(error))
            return False
        if not one.send(data, self._now_s):
            return False
        self.counts.sent += 1
        return True

    def drop(self, key: int, why: str) -> None:
        """End a connection for a reason, which its `LinkEvent` bears."""
        if key in self._connections:
            self._connections[key].drop(why)
            self._tally.refuse(why, self._connections[key].name)

    def name(self, key: int) -> str:
        """Who is at the other end of a connection."""
        return self._connections[key].name if key in self._connections else f"connection {key}"

    def close(self) -> None:
        """Hand over what waits, close all sockets. Safe to call twice."""
        for one in self._connections.values():
            one.link.flush()
            one.link.close()
        self._connections.clear()
        if self._listener is not None and not self._closed:
            self._listener.close()
        self._closed = True

    def _accept(self, now_s: float) -> None:
        while self._listener is not None and (link := self._listener.accept()) is not None:
            if len(self._connections) >= self._bounds.connections and not self._made_room(now_s):
                self._tally.refuse("too many connections", f"{self._bounds.connections} stand")
                link.close()
                continue
            self._join(link, now_s)

    def _made_room(self, now_s: float) -> bool:
        """Whether the oldest connection that has taken its time to shake hands was dropped for another one."""
        for one in self._connections.values():
            if not one.opened and one.link.alive and is_due(one.begun_s + PATIENCE_S, now_s):
                one.drop("handshake not finished when others came")
                return True
        return False

    def _join(self, link: Link, now_s: float) -> int:
        key = next(self._keys)
        direction = Direction.UP if self._server else Direction.DOWN
        handshake: Handshake
        if isinstance(self._secret, str):
            kind = ServerHandshake if self._server else ClientHandshake
            handshake = kind(self._secret)
        else:
            sealed = SealedServer if self._server else SealedClient
            handshake = sealed(keys=self._secret.by_vehicle)
        self._connections[key] = Connection(link, handshake, direction, self._bounds, now_s)
        return key
