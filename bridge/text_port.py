"""The CRATOUS text protocol over TCP between processes: one end that listens, one that connects.

Either UxAS's end, which speaks first, or ICAROUS's may be the one that listens. Nothing here blocks, except for the
look-up of a host name, and nothing raises because of a peer: what it sends is a record (a message, a refused or
skipped line), its end is a `LinkEvent`. A peer that does not complete the handshake, exceeds its rate, sends only
unreadable lines, or falls silent, is dropped with the reason.
"""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import zmq

from cratous.bridge.link import Link, LinkEvent, Listener, connect_later
from cratous.bridge.port import Address, Report, Tally, is_due
from cratous.bridge.text_connection import PROGRAM_LIMITS, Bounds, Connection, Opened
from cratous.bridge.text_protocol.authenticated_lines import SealedClient, SealedServer
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.format import encode
from cratous.bridge.text_protocol.handshake import (
    DEFAULT_SECRET,
    ClientHandshake,
    Handshake,
    ServerHandshake,
)
from cratous.bridge.text_protocol.keys import Keys
from cratous.bridge.text_protocol.layouts import ORIGINAL_LIMITS
from cratous.bridge.text_protocol.messages import (
    Direction,
    EpochTold,
    FenceVertex,
    ForgetFences,
    ForgetWaypoints,
    Heartbeat,
    Hello,
    IcarousPlans,
    LinesMissing,
    Message,
    NotKnown,
    StopMission,
    UxasPlans,
    VelocityOfAnother,
    WayOfAnother,
)
from cratous.bridge.text_protocol.parser import Record, WireError
from cratous.spec.errors import BadInput

OURS = (
    Hello,
    Heartbeat,
    LinesMissing,
    NotKnown,
    EpochTold,
    ForgetFences,
    ForgetWaypoints,
    StopMission,
    UxasPlans,
    IcarousPlans,
    WayOfAnother,
    VelocityOfAnother,
)
"""Messages that are not sent to peers of other dialects than ours."""
PATIENCE_S = 1.0
"""Time for which a connection without a handshake is kept where others wait for its place [s]."""


class Came(NamedTuple):
    """An event of one connection: it opened, a record, or its end, which comes last."""

    key: int
    what: Opened | Record | LinkEvent


class TextPort:
    """The text-protocol connections of one end, as a port for an event loop (`handles`, `due_s`, `step`)."""

    def __init__(
        self,
        where: Address,
        *,
        server: bool,
        listens: bool | None = None,
        bounds: Bounds | None = None,
        dialect: Dialect = Dialect.CRATOUS,
        secret: str | Keys = DEFAULT_SECRET,
        report: Report = lambda _severity, _text: None,
    ) -> None:
        """server: UxAS's end, which speaks first; else ICAROUS's. listens: accepts peers (BadInput if it cannot
        listen), otherwise it connects, see `dial`; as in the original, by default UxAS's end listens.

        dialect: of the peers. The original's: no HELLO and HBEAT, its number formats, no count above the size of its
        arrays. The thesis's: the same messages in its form. secret: of the compatible handshake; a `Keys` object
        selects the dialect v2.
        """
        self.where, self._server, self._dialect = where, server, dialect
        self._bounds, self._secret, self._report = bounds or Bounds(), secret, report
        self._tally = Tally(where.text, report)
        self.counts = self._tally.counts
        self._connections: dict[int, Connection] = {}
        self.numbers = itertools.count(1)  # of connections
        self._listener: Listener | None = None
        self._closed, self._now_s = False, 0.0
        if server if listens is None else listens:
            host = "0.0.0.0" if where.everywhere else where.host
            self._listener = Listener(host, where.port)

    @property
    def listens(self) -> bool:
        """True if it accepts connections, False if it makes them."""
        return self._listener is not None

    @property
    def bound(self) -> tuple[str, int]:
        """Host and port on which it listens."""
        assert self._listener is not None
        return self._listener.address

    @property
    def due_s(self) -> float | None:
        """When `step` must be called even if no bytes arrive [s, monotonic clock]; None: not needed."""
        times = [c.due_s for c in self._connections.values() if c.due_s is not None]
        return min(times, default=None)

    def handles(self) -> list[tuple[Any, int]]:
        """Sockets to poll, each with its flags."""
        found: list[tuple[Any, int]] = []
        if self._listener is not None and not self._closed:
            found.append((self._listener.fileno(), zmq.POLLIN))
        for one in self._connections.values():
            if one.link.alive:
                flags = zmq.POLLIN | (zmq.POLLOUT if one.link.waiting else 0)
                found.append((one.link.fileno(), flags))
        return found

    def dial(self, now_s: float, where: Address | None = None) -> int:
        """Connect to a listening end, by default `self.where`; returns the connection's key.

        Blocks only for the look-up of a host name: a failure to connect is the connection's `LinkEvent`.
        """
        where = where or self.where
        return self._join(connect_later((where.host, where.port)), now_s)

    def step(self, now_s: float) -> list[Came]:
        """Accept, read and write without blocking; what was received, by connection in order of arrival. now_s:
        monotonic clock [s]."""
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
        """Queue a message for connection `key`; False if it has gone or the message cannot be encoded."""
        one = self._connections.get(key)
        if one is None:
            return False
        if not self._dialect.ours and isinstance(message, OURS):
            return True
        original, dialect = self._dialect is Dialect.ORIGINAL, self._dialect
        if original and isinstance(message, FenceVertex):
            # the original writes zones of ten vertices in a way that its own client misreads
            dialect = Dialect.CRATOUS
        limits = ORIGINAL_LIMITS if original else PROGRAM_LIMITS
        try:
            data = encode(message, dialect=dialect, limits=limits)
        except BadInput as error:
            self._tally.lose("message has no form on the wire", str(error))
            return False
        if not one.send(data, self._now_s):
            return False
        self.counts.sent += 1
        return True

    def drop(self, key: int, why: str, detail: str = "") -> None:
        """End a connection; its `LinkEvent` carries the reason. why: used for counting, so it must not contain text
        chosen by the peer; detail: for this occurrence, by default `why`."""
        if key in self._connections:
            one = self._connections[key]
            one.drop(detail or why)
            self._tally.refuse(why, f"{one.name}: {detail}" if detail else one.name)

    def refuse(self, key: int, why: str, detail: str) -> None:
        """Tell a peer why it is refused, and end its connection, see `drop`."""
        if key in self._connections:
            one = self._connections[key]
            one.refuse(detail, self._now_s)
            self._tally.refuse(why, f"{one.name}: {detail}")

    def name(self, key: int) -> str:
        """The address of the peer of connection `key`."""
        return self._connections[key].name if key in self._connections else f"connection {key}"

    def close(self) -> None:
        """Write what is queued, then close all sockets. May be called twice."""
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
        """Drop the oldest connection whose time for the handshake is over, to make room; returns whether there was
        one."""
        for one in self._connections.values():
            if not one.opened and one.link.alive and is_due(one.begun_s + PATIENCE_S, now_s):
                one.drop("handshake not finished when others came")
                return True
        return False

    def _join(self, link: Link, now_s: float) -> int:
        key = next(self.numbers)
        direction = Direction.UP if self._server else Direction.DOWN
        handshake: Handshake
        if isinstance(self._secret, str):
            kind = ServerHandshake if self._server else ClientHandshake
            handshake = kind(self._secret)
        else:
            sealed = SealedServer if self._server else SealedClient
            handshake = sealed(keys=self._secret.by_vehicle)
        self._connections[key] = Connection(
            link, handshake, direction, self._dialect, self._bounds, now_s
        )
        return key
