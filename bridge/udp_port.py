"""Messages over UDP, one datagram each, without delivery guarantees.

Losses in the network cannot be counted; messages that do not fit a datagram, or that the system does not accept, are
counted here.
"""

from __future__ import annotations

import socket
from typing import Any

import zmq

from cratous.bridge.port import Address, Incoming, Limits, Report, Tally
from cratous.spec.errors import BadInput

MAX_DATAGRAM = 65507  # [bytes] of a UDP datagram over IPv4
_BATCH = 2000


def _socket(where: Address, bind: bool) -> socket.socket:
    host = where.host
    if where.everywhere:
        host = "" if bind else "127.0.0.1"
    sock = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_DGRAM)
    sock.setblocking(False)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 * 1024 * 1024)
    try:
        if bind:
            sock.bind((host, where.port))
        else:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
            sock.connect((host, where.port))
    except OSError as error:
        sock.close()
        raise BadInput(
            "cannot listen" if bind else "cannot send there",
            where=where.text,
            expected="a free port" if bind else "an address",
            got=error.strerror or str(error),
        ) from None
    return sock


class UdpPort:
    """Sends datagrams to one address and receives them on another; either may be missing."""

    due_s: float | None = None

    def __init__(
        self,
        to: Address | None,
        at: Address | None,
        *,
        limits: Limits | None = None,
        report: Report = lambda _severity, _text: None,
    ) -> None:
        self._tally = Tally(" and ".join(a.text for a in (to, at) if a), report)
        self.counts = self._tally.counts
        self._limits = limits or Limits()
        self._in = _socket(at, True) if at else None
        try:
            self._out = _socket(to, False) if to else None
        except BadInput:
            if self._in is not None:
                self._in.close()
            raise

    @property
    def bound(self) -> tuple[str, int]:
        """Host and port at which it receives."""
        assert self._in is not None
        host, port = self._in.getsockname()[:2]
        return host, port

    def handles(self) -> list[tuple[Any, int]]:
        """The receiving socket to poll, with its flags."""
        return [(self._in.fileno(), zmq.POLLIN)] if self._in is not None else []

    def step(self, now_s: float) -> list[Incoming]:
        """The datagrams that have arrived. now_s: monotonic clock [s]."""
        found: list[Incoming] = []
        for _ in range(_BATCH if self._in is not None else 0):
            assert self._in is not None
            try:
                data, place = self._in.recvfrom(65536)
            except (BlockingIOError, InterruptedError):
                break
            except ConnectionError:
                continue
            if len(data) > self._limits.payload_bytes:
                self._tally.refuse("message longer than the limit", f"{len(data)} bytes")
                continue
            found.append(Incoming((data,), f"{place[0]}:{place[1]}"))
        self.counts.received += len(found)
        return found

    def send(self, parts: tuple[bytes, ...]) -> None:
        """Send one datagram; a message that is too long or not accepted by the system is counted as lost."""
        if self._out is None:
            return
        payload = b"".join(parts)
        if len(payload) > MAX_DATAGRAM:
            self._tally.lose("message longer than a datagram", f"{len(payload)} bytes")
            return
        try:
            self._out.send(payload)
        except OSError as error:  # queue full, or no receiver
            self._tally.lose("not taken by the network", error.strerror or str(error))
            return
        self.counts.sent += 1

    def close(self) -> None:
        """Close both sockets. May be called twice."""
        for sock in (self._in, self._out):
            if sock is not None:
                sock.close()
