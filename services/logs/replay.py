"""Sends the messages of a log again, at any rate, to a stream or to a TCP peer.

Time intervals are divided by the rate; each message has its own due time, so that delays do not
accumulate. What the peer sends is read and dropped, since a simulator that cannot send blocks. A
peer that does not read for `STALL_S`, or disconnects, is a typed error with the number of messages
sent.
"""

from __future__ import annotations

import select
import socket
import time
from collections.abc import Callable, Iterable
from typing import Protocol

from cratous.services.logs.entry import Entry
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of

STALL_S = 10.0
_BLOCK = 1 << 16


class Out(Protocol):
    """Destination of a replay."""

    def send(self, data: bytes) -> None:
        """Send the bytes of one message."""

    def wait(self, seconds: float) -> None:
        """Wait for `seconds` [s]."""


class StreamOut:
    """A replay to a binary stream (standard output)."""

    def __init__(self, write: Callable[[bytes], object], flush: Callable[[], object]) -> None:
        self._write, self._flush = write, flush

    def send(self, data: bytes) -> None:
        self._write(data)

    def wait(self, seconds: float) -> None:
        self._flush()
        time.sleep(seconds)


class TcpOut:
    """A replay to one TCP peer."""

    def __init__(self, peer: socket.socket, stall_s: float = STALL_S) -> None:
        self._peer, self._stall_s = peer, stall_s
        self.received = 0  # bytes received from the peer, which are dropped
        peer.setblocking(False)

    def send(self, data: bytes) -> None:
        rest = memoryview(data)
        while rest:
            readable, writable, _ = select.select([self._peer], [self._peer], [], self._stall_s)
            if readable:
                self._drain()
            elif not writable:
                raise BadInput(
                    "the peer does not read", expected=f"some bytes within {self._stall_s:g} s"
                )
            if writable:
                try:
                    rest = rest[self._peer.send(rest) :]
                except BlockingIOError:
                    continue
                except OSError as error:
                    raise BadInput("the connection is lost", got=str(error)) from None

    def wait(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            readable, _, _ = select.select([self._peer], [], [], left)
            if readable:
                self._drain()

    def _drain(self) -> None:
        try:
            data = self._peer.recv(_BLOCK)
        except BlockingIOError:
            return
        except OSError as error:
            raise BadInput("the connection is lost", got=str(error)) from None
        if not data:
            raise BadInput("the connection is lost", got="closed by the peer")
        self.received += len(data)


def parse_address(text: str) -> tuple[str, int]:
    """Host and port of `tcp://host:port`; `*` is every interface."""
    host, colon, port = text.removeprefix("tcp://").rpartition(":")
    number = integer_of(port, 0, 65535)
    if not colon or not host or number is None:
        raise BadInput("not an address", expected="tcp://host:port", got=text)
    return ("" if host == "*" else host.strip("[]")), number


def connect(address: str, timeout_s: float = 10.0) -> socket.socket:
    """A connection to a server; BadInput if it does not answer within timeout_s [s]."""
    try:
        return socket.create_connection(parse_address(address), timeout=timeout_s)
    except OSError as error:
        raise BadInput("cannot connect", where=address, got=str(error)) from None


def accept(address: str, tell: Callable[[str], None]) -> socket.socket:
    """Wait for the first client at an address; tell(address) reports the address in use, for port 0."""
    try:
        with socket.create_server(parse_address(address)) as server:
            host, port = server.getsockname()[:2]
            tell(f"tcp://{host}:{port}")
            return server.accept()[0]
    except OSError as error:
        raise BadInput("cannot listen", where=address, got=str(error)) from None


def replay(
    entries: Iterable[Entry],
    out: Out,
    form: Callable[[Entry], bytes],
    rate: float,
    on_skip: Callable[[Entry, BadInput], None],
    clock: Callable[[], float] = time.monotonic,
) -> int:
    """Send the messages; returns how many. rate: 2 is twice as fast, 0 as fast as possible.

    on_skip is called for messages that cannot be sent in this form; clock: seconds, which
    `out.wait` lets pass.
    """
    if not 0 <= rate < float("inf"):
        raise BadInput("wrong rate", item="rate", expected="a number from 0", got=f"{rate}")
    start = clock()
    first_ms: int | None = None
    sent = 0
    for entry in entries:
        first_ms = entry.time_ms if first_ms is None else first_ms
        if rate:
            due = start + (entry.time_ms - first_ms) / 1000 / rate
            pause = due - clock()
            if pause > 0:
                out.wait(pause)
        try:
            data = form(entry)
        except BadInput as error:
            on_skip(entry, error)
            continue
        try:
            out.send(data)
        except BadInput as error:
            error.where = error.where or f"after {sent} messages"
            raise
        sent += 1
    out.wait(0)
    return sent
