"""One connection of the text protocol: socket, handshake, parser and resource limits.

A peer of another dialect is sent a line `error,REASON` before it is dropped, so that both ends know the reason.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from cratous.bridge.link import MAX_PENDING, Link, LinkEvent
from cratous.bridge.port import is_due
from cratous.bridge.send_queue import Outgoing
from cratous.bridge.text_protocol.authenticated_lines import (
    MOST_UNACKNOWLEDGED,
    Seal,
    SealedHandshake,
)
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.handshake import Handshake
from cratous.bridge.text_protocol.layouts import Limits
from cratous.bridge.text_protocol.messages import Direction, Hello, Message
from cratous.bridge.text_protocol.parser import (
    OTHER_DIALECT,
    Record,
    Skipped,
    StreamParser,
    WireError,
)

PROGRAM_LIMITS = Limits(10_000, 1000, 1000, 9999, 9999)
"""The largest counts that the two programs accept; a vehicle's memory is bounded by them."""
_READS = 16
REFUSED = "refused"
"""The kind of the end of a connection whose ends speak different dialects."""
REFUSAL = "error,"
"""The start of the line that tells a peer why it is refused, as in the opening of v2."""
PARTING_S = 2.0
"""Time that a refused peer has to read the reason before it is dropped [s]."""
MOST_UNREAD = 32_768
"""The original's client crashes on a read of 65,535 bytes or more: nothing is sent while this many bytes are unread."""
AGAIN_S = 0.05
"""Interval at which it is checked whether the peer has read [s]."""
NOISE, SILENT, LATE, FAST, NOBODY, DEAF, STOPPED = (
    "nothing but what cannot be read",
    "silent",
    "handshake not finished in time",
    "sends faster than it may",
    "no program listens there",
    "does not acknowledge what it is sent",
    "does not read",
)


@dataclass(frozen=True)
class Bounds:
    """Resource limits of one peer.

    handshake_s: limit of the handshake [s]; silence_s: longest silence [s], None: unlimited; bytes_per_s,
    burst_bytes: sustained rate and burst accepted; bad_lines: consecutive unreadable lines before it is dropped;
    connections: peers at once; stopped_s: how long an original's client may leave queued lines unread [s].
    """

    handshake_s: float = 10.0
    silence_s: float | None = 300.0
    bytes_per_s: float = 1 << 20
    burst_bytes: float = 8 << 20
    bad_lines: int = 1000
    connections: int = 64
    stopped_s: float = 10.0


class Opened(NamedTuple):
    """The handshake is complete: messages may follow. peer: the other end's address."""

    peer: str


class Connection:
    """One peer: socket, handshake, parser, and the resources that it has used."""

    def __init__(
        self,
        link: Link,
        handshake: Handshake,
        direction: Direction,
        dialect: Dialect,
        bounds: Bounds,
        now_s: float,
    ) -> None:
        """direction: of received messages. now_s: monotonic clock [s]."""
        self.link, self._handshake, self._bounds = link, handshake, bounds
        self._parser = StreamParser(
            direction, limits=PROGRAM_LIMITS, original_peer=True, dialect=dialect
        )
        self._dialect, self._understood, self._refused = dialect, False, ""
        self._direction, self.name = direction, link.remote_name
        self._until_s: float | None = now_s + bounds.handshake_s
        self.begun_s, self.opened = now_s, False
        self._room, self._at_s, self._bad = bounds.burst_bytes, now_s, 0
        self._waiting, self._stopped_s, self._looked_s = Outgoing(), now_s, now_s
        self.link.send(handshake.start())

    @property
    def seal(self) -> Seal | None:
        """Packet sealing of dialect v2; None before the handshake is complete, and in other dialects."""
        return self._handshake.seal if isinstance(self._handshake, SealedHandshake) else None

    def send(self, line: bytes, now_s: float) -> bool:
        """Queue a line at now_s [s]; False if the peer has gone or is being refused."""
        if self._refused:
            return False
        if self._dialect is Dialect.ORIGINAL:
            return self._queue(line, now_s)
        if not isinstance(self._handshake, SealedHandshake):
            return self.link.send(line)
        seal = self.seal
        if seal is None:
            return False  # nothing is sent before the handshake is complete
        if seal.unacknowledged not in range(MOST_UNACKNOWLEDGED):
            self.drop(DEAF)
            return False
        return self.link.send(seal.wrap(line, round(1000 * now_s)))

    @property
    def due_s(self) -> float | None:
        """When a silent peer is dropped, or queued lines are tried again [s]; None: never."""
        if not self._waiting:
            return self._until_s
        again_s = self._looked_s + AGAIN_S
        return again_s if self._until_s is None else min(again_s, self._until_s)

    def _queue(self, line: bytes, now_s: float) -> bool:
        """Queue a line for the original's client until it has read enough."""
        if not self.link.alive:
            return False
        if self._waiting.waiting + len(line) > MAX_PENDING:
            self.drop(STOPPED)
            return False
        if not self._waiting:
            self._stopped_s = now_s + self._bounds.stopped_s
        self._waiting.put(line)
        self._pour(now_s)
        return True

    def _pour(self, now_s: float) -> None:
        """Send complete lines while the peer has read enough of the previous ones; it is dropped if none can be sent
        for too long."""
        self._looked_s = now_s
        unread = self.link.unread
        while self._waiting:
            line = self._waiting.next()
            if unread is not None and unread + self.link.waiting + len(line) > MOST_UNREAD:
                break
            self.link.send(bytes(line))
            self._waiting.took(len(line))
            self._stopped_s = now_s + self._bounds.stopped_s
            unread = None if unread is None else unread + len(line)
        if self._waiting and is_due(self._stopped_s, now_s):
            self.drop(f"{STOPPED}: {unread} bytes, and {self._waiting.waiting} more are waiting")

    def step(self, now_s: float) -> list[Opened | Record | LinkEvent]:
        """Read and write without blocking; what was received, in order. now_s: monotonic clock [s]."""
        if self._waiting and self.link.alive:
            self._pour(now_s)
        self.link.flush()
        self.link.drain(_READS)
        data = self.link.take()
        if not self.opened and self.link.itself:
            self.drop(NOBODY)
            data = b""
        if self._refused:  # data from a refused peer are ignored
            return self._part(now_s)
        found = self._read(data, now_s) if data else []
        self._spend(len(data), now_s)
        if data and self._handshake.done and not self._refused:
            silence_s = self._bounds.silence_s
            self._until_s = None if silence_s is None else now_s + silence_s
        if is_due(self._until_s, now_s) and not self._refused:
            self.drop(SILENT if self._handshake.done else LATE)
        if self._refused:
            return found + self._part(now_s)
        if not self.link.alive:
            found += self._parser.finish()
            found.append(self.link.ended or LinkEvent("closed"))
        return found

    def drop(self, why: str, kind: str = "dropped") -> None:
        """Drop the peer because of `why`; the next `step` returns the end, of this kind."""
        if self.link.ended is None:
            self.link.flush()
            self.link.ended = LinkEvent(kind, why)

    def refuse(self, why: str, now_s: float) -> None:
        """Tell the peer why it is refused, and drop it PARTING_S seconds after now_s [s]: an immediate close could
        destroy the message before it is read."""
        if self._refused or not self.link.alive:
            return
        line = f"{REFUSAL}{why}\n".encode("ascii", "replace")
        self.link.send(line if self.seal is None else self.seal.wrap(line, round(1000 * now_s)))
        self._refused, self._until_s = why, now_s + PARTING_S

    def _part(self, now_s: float) -> list[Opened | Record | LinkEvent]:
        """The end of a refused peer, once it has disconnected or its time is over."""
        if self.link.alive and not is_due(self._until_s, now_s):
            return []
        self.link.ended = LinkEvent(REFUSED, self._refused)
        return [self.link.ended]

    def _read(self, data: bytes, now_s: float) -> list[Opened | Record | LinkEvent]:
        found: list[Opened | Record | LinkEvent] = []
        if not self._handshake.done:
            self.link.send(self._handshake.feed(data))
            if self._handshake.failed:
                self.link.flush()  # the reason is sent even if the connection has ended meanwhile
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
            if isinstance(record, Skipped) and record.text.startswith(REFUSAL):
                self.drop(f"the other end refuses: {record.text[len(REFUSAL) :]}", REFUSED)
                break
            found.append(record)
            wrong_dialect = isinstance(record, WireError) and record.what == OTHER_DIALECT
            if wrong_dialect and not self._understood:
                self.refuse(f"{OTHER_DIALECT}: {self._dialect.value} is spoken here", now_s)
                break
            self._understood = self._understood or isinstance(record, Message)
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
