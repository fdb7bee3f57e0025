"""The CRATOUS bridge within one process: for each vehicle a real TCP connection on loopback.

UxAS has the server ends, every ICAROUS instance a client end. Messages are queued by `to_icarous` and `to_uxas` and
delivered by `exchange`, once per virtual step, sorted by vehicle, direction and order of sending. Ports, the order of
accepting and the wall clock do not affect what is delivered; nor does how the bytes are segmented (`segmenter`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cratous.bridge.link import Link, LinkEvent, Listener, connect_pair, pump
from cratous.bridge.text_protocol.format import direction_of, encode, may_go
from cratous.bridge.text_protocol.handshake import (
    DEFAULT_SECRET,
    ClientHandshake,
    Handshake,
    ServerHandshake,
)
from cratous.bridge.text_protocol.layouts import (
    WIDE_LIMITS,
    Limits,
)
from cratous.bridge.text_protocol.messages import (
    Direction,
    Hello,
    Message,
)
from cratous.bridge.text_protocol.parser import Record, StreamParser
from cratous.spec.errors import BadInput, CratousError

Segmenter = Callable[[bytes], Iterable[bytes]]
_HANDSHAKE_ROUNDS = 8


class BridgeError(CratousError):
    """The bridge could not be opened; the text gives the disagreement between the two ends."""


class Delivered(NamedTuple):
    """One delivery: a message, a line that was skipped or refused, or the end of the connection."""

    vehicle_id: int
    direction: Direction
    record: Record | LinkEvent


@dataclass
class Counters:
    """Messages and bytes sent in one direction since the bridge was opened, without the handshake."""

    messages: int = 0
    bytes: int = 0


class _End:
    """One end of one connection: what it sends, and the parser of what it receives."""

    def __init__(self, link: Link, parser: StreamParser, segmenter: Segmenter | None) -> None:
        self.link, self._parser, self._segmenter = link, parser, segmenter
        self._over = False

    def send(self, data: bytes) -> bool:
        pieces = self._segmenter(data) if self._segmenter else (data,)
        return all(self.link.send(piece) for piece in pieces)

    def pieces(self) -> Iterable[bytes]:
        data = self.link.take()
        return self._segmenter(data) if self._segmenter and data else (data,)

    def records(self, rest: bytes = b"") -> list[Record | LinkEvent]:
        """Records received since the last call; the end of the link once, as the last record."""
        records: list[Record | LinkEvent] = []
        for piece in (rest, *self.pieces()):
            records += self._parser.feed(piece)
        if self.link.ended is not None and not self._over:
            self._over = True
            records += self._parser.finish()
            records.append(self.link.ended)
        return records


class Bridge:
    """Connections for some vehicles, opened with their handshakes done.

    secret: 64 hexadecimal characters, no security measure. limits: the largest counts that both parsers accept
    (`ORIGINAL_LIMITS` for the capacity of the original). segmenter: splits what is sent and what is read, for tests.
    """

    def __init__(
        self,
        vehicle_ids: Sequence[int],
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        secret: str = DEFAULT_SECRET,
        limits: Limits = WIDE_LIMITS,
        segmenter: Segmenter | None = None,
        watchdog_s: float = 10.0,
    ) -> None:
        if len(set(vehicle_ids)) != len(vehicle_ids):
            raise BadInput(
                "vehicle twice on the bridge",
                item="vehicles",
                expected="different ids",
                got=", ".join(map(str, vehicle_ids)),
            )
        self._limits, self._watchdog_s = limits, watchdog_s
        self._secret, self._segmenter = secret, segmenter
        self.now_ms = 0  # virtual time, set by the caller of `exchange`; only faults use it
        self.counters = {direction: Counters() for direction in Direction}
        self._uxas: dict[int, _End] = {}
        self._icarous: dict[int, _End] = {}
        self._links: list[Link] = []
        self._encoded: dict[int, tuple[Message, bytes]] = {}
        self._listener = Listener(host, port)
        try:
            self._open(sorted(vehicle_ids))
        except BaseException:
            self.close()
            raise

    @property
    def vehicle_ids(self) -> tuple[int, ...]:
        """The vehicles that have a connection, in the order given."""
        return tuple(self._icarous)

    def to_icarous(self, vehicle_id: int, message: Message) -> bool:
        """Queue a message from UxAS for the vehicle's ICAROUS; False if the link is dead."""
        return self._send(self._uxas, vehicle_id, message, Direction.DOWN)

    def to_uxas(self, vehicle_id: int, message: Message) -> bool:
        """Queue a message from the vehicle's ICAROUS for UxAS; False if the link is dead."""
        return self._send(self._icarous, vehicle_id, message, Direction.UP)

    def exchange(self) -> list[Delivered]:
        """Deliver all that was queued; sorted by vehicle, direction (down first) and order of sending."""
        pump(self._links, self._watchdog_s)
        self._encoded.clear()
        delivered = []
        for vehicle_id in self._icarous:
            for direction, ends in (
                (Direction.DOWN, self._icarous),
                (Direction.UP, self._uxas),
            ):
                for record in ends[vehicle_id].records():
                    delivered.append(Delivered(vehicle_id, direction, record))
        return delivered

    def opened_anew(self) -> list[int]:
        """The vehicles whose connections were re-established since the last call; without faults none breaks."""
        return []

    def alive(self, vehicle_id: int) -> bool:
        """True while both ends of the vehicle's connection can send."""
        return self._uxas[vehicle_id].link.alive and self._icarous[vehicle_id].link.alive

    def cut(self, vehicle_id: int) -> None:
        """Break a vehicle's connection like a lost link; what was sent before still arrives."""
        pump(self._links, self._watchdog_s)  # unread bytes would turn the end of file into a reset
        self._icarous[vehicle_id].link.close()
        pump(self._links, self._watchdog_s)

    def reopen(self, vehicle_ids: Sequence[int]) -> None:
        """Open new connections for vehicles whose connections are broken, each with a handshake."""
        for vid in vehicle_ids:
            for end in (self._uxas[vid], self._icarous[vid]):
                end.link.close()
                self._links.remove(end.link)
        self._open(sorted(vehicle_ids))

    def close(self) -> None:
        """Close all sockets. May be called twice."""
        for link in self._links:
            link.close()
        self._listener.close()

    def __enter__(self) -> Bridge:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self.close()

    def _hand_over(self, vehicle_id: int, direction: Direction, data: bytes) -> bool:
        """Pass the bytes of a line to the sending end's socket; False if the link is dead."""
        ends = self._uxas if direction is Direction.DOWN else self._icarous
        return ends[vehicle_id].send(data)

    def _send(
        self, ends: dict[int, _End], vehicle_id: int, message: Message, direction: Direction
    ) -> bool:
        if vehicle_id not in ends:
            raise BadInput(
                "vehicle without a bridge",
                item=f"vehicle {vehicle_id}",
                expected=" or ".join(map(str, ends)),
            )
        if not may_go(message, direction):
            raise BadInput(
                "message of the other direction",
                item=type(message).__name__,
                expected=direction.value,
                got=direction_of(message).value,
            )
        # a message to many vehicles is one object, encoded once
        before, data = self._encoded.get(id(message), (None, b""))
        if before is not message:
            data = encode(message, limits=self._limits)
            self._encoded[id(message)] = message, data
        if not self._hand_over(vehicle_id, direction, data):
            return False
        count = self.counters[direction]
        count.messages += 1
        count.bytes += len(data)
        return True

    def _open(self, vehicle_ids: Sequence[int]) -> None:
        secret, segmenter = self._secret, self._segmenter
        servers: list[tuple[_End, Handshake]] = []
        clients: list[tuple[_End, Handshake]] = []
        for vehicle_id in vehicle_ids:
            server, client = connect_pair(self._listener, self._watchdog_s)
            self._links += [server, client]
            up = StreamParser(Direction.UP, limits=self._limits)
            down = StreamParser(Direction.DOWN, limits=self._limits)
            servers.append((_End(server, up, segmenter), ServerHandshake(secret)))
            clients.append((_End(client, down, segmenter), ClientHandshake(secret)))
            self._icarous[vehicle_id] = clients[-1][0]
        ends = servers + clients
        for end, handshake in ends:
            end.send(handshake.start())
        for _ in range(_HANDSHAKE_ROUNDS):
            pump(self._links, self._watchdog_s)
            for end, handshake in ends:
                for piece in end.pieces():
                    end.send(handshake.feed(piece))
                if handshake.failed:
                    raise BridgeError(f"the handshake failed: {handshake.failed}")
            if all(handshake.done for _, handshake in ends):
                break
        else:
            raise BridgeError("the handshake did not come to an end")
        for vehicle_id, (end, _) in zip(vehicle_ids, clients, strict=True):
            end.send(encode(Hello(vehicle_id), limits=self._limits))
        pump(self._links, self._watchdog_s)
        for end, handshake in servers:
            first = end.records(handshake.rest)
            if len(first) != 1 or not isinstance(first[0], Hello):
                raise BridgeError(f"expected HELLO as the first message, got {first!r}")
            self._uxas[first[0].vehicle_id] = end
        if sorted(self._uxas) != list(self._icarous):
            raise BridgeError("a client speaks for a vehicle that is not its own")
