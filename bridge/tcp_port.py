"""Sentinel frames over TCP: one server with any number of clients, or one client that reconnects.

Compatible with UxAS's TCP bridge and AMASE, without their faults: frames may arrive in any segmentation and of any
size within the limit; a peer that sends garbage, never completes a frame or does not read is limited and reported,
and does not affect the others.
"""

from __future__ import annotations

import os
import select
import socket
from collections.abc import Sequence
from typing import Any

import zmq

from cratous.bridge import sentinel
from cratous.bridge.port import Address, Incoming, Limits, Report, Tally, is_due
from cratous.bridge.send_queue import Outgoing
from cratous.spec.errors import BadInput

_CHUNK = 65536
_READS = 16  # reads from one peer in one step, so that a fast one leaves time for the others
_MOST_UNFINISHED = 3
_MOST_STRAYS = 10_000  # consecutive pieces of data that are not a frame
_RETRY_S = (0.1, 2.0)  # first and longest pause between attempts to connect

STALLED = "peer does not read"
NOBODY = "not connected"
LATE = "frame not finished in time"
FULL = "too many connections"
HELD = "unfinished frames hold too much memory"
NOISE = "nothing but what is no frame"


class _Connection:
    """One peer: its socket, the incomplete frame received, and the outgoing queue."""

    def __init__(self, sock: socket.socket, name: str, stream: sentinel.FrameStream) -> None:
        self.sock, self.name, self.stream = sock, name, stream
        self.out = Outgoing()
        self.begun_s: float | None = None  # when the incomplete frame began
        self.unfinished = 0
        self.writing = False
        self.connecting = False


class TcpPort:
    """A TCP port for sentinel frames; see the module. `parts` of a message is its payload alone."""

    def __init__(
        self,
        where: Address,
        *,
        server: bool,
        limits: Limits | None = None,
        report: Report = lambda _severity, _text: None,
    ) -> None:
        """Server: listens at once, BadInput if it cannot. Client: connects, and reconnects indefinitely."""
        self._where, self._server = where, server
        self._limits = limits or Limits()
        self._tally = Tally(where.text, report)
        self._report = report
        self.counts = self._tally.counts
        self._poll = select.epoll()
        self._peers: dict[int, _Connection] = {}
        self._listener: socket.socket | None = None
        self._again_s = 0.0
        self._pause_s = _RETRY_S[0]
        self._failures = 0  # attempts since the last connection
        self._paused_s: float | None = None  # no connections are accepted until then
        self._now_s = 0.0
        self._closed = False
        if server:
            self._listen()

    @property
    def bound(self) -> tuple[str, int]:
        """Host and port on which the server listens."""
        assert self._listener is not None
        host, port = self._listener.getsockname()[:2]
        return host, port

    @property
    def peers(self) -> int:
        """Number of established connections."""
        return sum(not peer.connecting for peer in self._peers.values())

    @property
    def waiting(self) -> int:
        """Bytes queued for peers."""
        return sum(peer.out.waiting for peer in self._peers.values())

    @property
    def due_s(self) -> float | None:
        """When `step` must be called even if no bytes arrive [s, monotonic clock]; None: not needed."""
        times = [
            p.begun_s + self._limits.frame_s for p in self._peers.values() if p.begun_s is not None
        ]
        if self._paused_s is not None:
            times.append(self._paused_s)
        if not self._server and not self._peers:
            times.append(self._again_s)
        return min(times, default=None)

    def handles(self) -> list[tuple[Any, int]]:
        """The epoll object to poll; it is ready when any of the port's sockets is."""
        return [] if self._closed else [(self._poll.fileno(), zmq.POLLIN)]

    def step(self, now_s: float) -> list[Incoming]:
        """Accept or connect, read and write without blocking; the complete payloads in order. now_s: monotonic clock
        [s]."""
        self._now_s = now_s
        if self._closed:
            return []
        self._maintain()
        found: list[Incoming] = []
        for fd, mask in self._poll.poll(0, 4096):
            if self._listener is not None and fd == self._listener.fileno():
                self._accept()
                continue
            peer = self._peers.get(fd)
            if peer is None:
                continue
            if peer.connecting:
                self._connected(peer)
                continue
            if mask & select.EPOLLOUT:
                self._flush(peer)
            if mask & (select.EPOLLIN | select.EPOLLHUP | select.EPOLLERR):
                self._read(peer, found)
        self._abandon_late(found)
        self.counts.received += len(found)
        return found

    def send(self, parts: tuple[bytes, ...], but: str = "") -> None:
        """Queue the payload for every peer except the one named `but`; without any peer, a client counts it as lost."""
        self._send([b"".join(parts)], but)

    def send_together(self, payloads: Sequence[bytes]) -> None:
        """Queue several payloads for every peer as one piece of data, so that they are read together as far as the
        peer's buffer goes."""
        self._send(payloads)

    def _send(self, payloads: Sequence[bytes], but: str = "") -> None:
        for payload in payloads:
            if len(payload) > self._limits.payload_bytes:
                self._tally.lose("message longer than the limit", f"{len(payload)} bytes")
                return
        peers = [p for p in self._peers.values() if not p.connecting and p.name != but]
        if not peers:
            if not self._server:
                self._tally.lose(NOBODY)
            return
        frame = b"".join(map(sentinel.frame, payloads))
        self.counts.sent += len(payloads)
        for peer in peers:
            self._queue(peer, frame)

    def shut(self) -> None:
        """Stop accepting connections; established ones stay. May be called twice."""
        if self._listener is not None:
            self._poll.unregister(self._listener.fileno())
            self._listener.close()
            self._listener, self._paused_s = None, None

    def redial(self, why: str) -> None:
        """Client only: drop the connection or attempt because of `why`, and connect again at once. Queued messages
        are lost and counted."""
        for peer in list(self._peers.values()):
            self._drop(peer, why)
        self._again_s = self._now_s

    def close(self) -> None:
        """Try to write what is queued, then close all sockets. May be called twice."""
        if self._closed:
            return
        for peer in list(self._peers.values()):
            self._flush(peer)
            if peer.out and not peer.connecting:
                self._tally.lose("closed before all was sent", f"{len(peer.out)} messages")
            self._drop(peer, "closed", quiet=True)
        if self._listener is not None:
            self._listener.close()
        self._poll.close()
        self._closed = True

    def _listen(self) -> None:
        host = "" if self._where.everywhere else self._where.host
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        sock = socket.socket(family, socket.SOCK_STREAM)
        try:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            sock.bind((host, self._where.port))
            sock.listen(1024)
        except OSError as error:
            sock.close()
            self._poll.close()
            raise BadInput(
                "cannot listen",
                where=self._where.text,
                expected="a free port of this machine",
                got=error.strerror or str(error),
            ) from None
        sock.setblocking(False)
        self._listener = sock
        self._poll.register(sock.fileno(), select.EPOLLIN)

    def _maintain(self) -> None:
        now = self._now_s
        if self._listener is not None and is_due(self._paused_s, now):
            self._paused_s = None
            self._poll.modify(self._listener.fileno(), select.EPOLLIN)
        if not self._server and not self._peers and is_due(self._again_s, now):
            self._connect()

    def _accept(self) -> None:
        assert self._listener is not None
        for _ in range(256):
            try:
                sock, place = self._listener.accept()
            except (BlockingIOError, InterruptedError):
                return
            except ConnectionError:
                continue
            except OSError as error:  # no file descriptor is left: retry in a second
                self._tally.refuse(FULL, error.strerror or str(error))
                self._paused_s = self._now_s + 1.0
                self._poll.modify(self._listener.fileno(), 0)
                return
            name = f"{place[0]}:{place[1]}"
            if len(self._peers) >= self._limits.connections:
                sock.close()
                self._tally.refuse(FULL, f"{name}; {self._limits.connections} are open")
                continue
            self._join(sock, name)
            self._report("INFO", f"{self._where.text}: {name} has connected ({self.peers} open)")

    def _join(self, sock: socket.socket, name: str) -> _Connection:
        sock.setblocking(False)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)

        def dropped(drop: sentinel.Drop) -> None:
            self._tally.refuse(drop.reason, str(drop.error(name)))

        stream = sentinel.FrameStream(
            max_payload=self._limits.payload_bytes, max_strays=_MOST_STRAYS, on_drop=dropped
        )
        peer = _Connection(sock, name, stream)
        self._peers[sock.fileno()] = peer
        self._poll.register(sock.fileno(), select.EPOLLIN)
        return peer

    def _connect(self) -> None:
        host = "127.0.0.1" if self._where.everywhere else self._where.host
        family = socket.AF_INET6 if ":" in host else socket.AF_INET
        sock = socket.socket(family, socket.SOCK_STREAM)
        sock.setblocking(False)
        error = ""
        try:
            code = sock.connect_ex((host, self._where.port))
            if code not in (0, 115, 11):  # in progress
                error = os.strerror(code)
        except OSError as err:
            error = err.strerror or str(err)
        if error:
            sock.close()
            self._retry(error)
            return
        peer = self._join(sock, self._where.text)
        peer.connecting = True
        self._poll.modify(sock.fileno(), select.EPOLLOUT)

    def _connected(self, peer: _Connection) -> None:
        code = peer.sock.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
        # the system may assign our end the port of this machine that it connects to, if nobody listens on it
        itself = code == 0 and peer.sock.getsockname() == peer.sock.getpeername()
        if code or itself:
            self._forget(peer)
            self._retry("nobody listens" if itself else os.strerror(code))
            return
        peer.connecting = False
        self._failures = 0
        self._pause_s = _RETRY_S[0]
        self._poll.modify(peer.sock.fileno(), select.EPOLLIN)
        self._report("INFO", f"{self._where.text}: connected")

    def _retry(self, why: str) -> None:
        self._failures += 1
        if self._failures == 1:
            self._report("INFO", f"{self._where.text}: not connected ({why}); trying again")
        self._again_s = self._now_s + self._pause_s
        self._pause_s = min(2 * self._pause_s, _RETRY_S[1])

    def _read(self, peer: _Connection, found: list[Incoming]) -> None:
        for _ in range(_READS):
            try:
                data = peer.sock.recv(_CHUNK)
            except (BlockingIOError, InterruptedError):
                break
            except OSError as error:
                self._finish(peer, found, error.strerror or str(error))
                return
            if not data:
                self._finish(peer, found, "closed by the peer")
                return
            payloads = peer.stream.feed(data)
            found.extend(Incoming((payload,), peer.name) for payload in payloads)
            if peer.stream.spoiled:
                self._tally.refuse(NOISE, f"{peer.name}, {_MOST_STRAYS} pieces in a row")
                self._drop(peer, NOISE)
                return
            if payloads or not peer.stream.pending:
                peer.begun_s = None
            if peer.stream.pending and peer.begun_s is None:
                peer.begun_s = self._now_s
            if len(data) < _CHUNK:
                break
        held = sum(p.stream.pending for p in self._peers.values()) if peer.stream.pending else 0
        if held > self._limits.held_bytes:
            self._tally.refuse(HELD, f"{peer.name} with {peer.stream.pending} bytes")
            self._drop(peer, HELD)

    def _finish(self, peer: _Connection, found: list[Incoming], why: str) -> None:
        found.extend(Incoming((p,), peer.name) for p in peer.stream.close())
        self._drop(peer, why)

    def _abandon_late(self, found: list[Incoming]) -> None:
        limit = self._limits.frame_s
        late = [
            p
            for p in self._peers.values()
            if p.begun_s is not None and is_due(p.begun_s + limit, self._now_s)
        ]
        for peer in late:
            found.extend(Incoming((p,), peer.name) for p in peer.stream.abandon())
            peer.begun_s = self._now_s if peer.stream.pending else None
            peer.unfinished += 1
            self._tally.refuse(LATE, f"{peer.name}, {limit:g} s")
            if peer.unfinished >= _MOST_UNFINISHED:
                self._drop(peer, LATE)

    def _queue(self, peer: _Connection, frame: bytes) -> None:
        room = self._limits.waiting_bytes
        if not peer.out:  # even one that is larger than the queue
            peer.out.put(frame)
            self._flush(peer)
            return
        if self._limits.when_full == "DropOldest":
            # the first one may be partly written: it stays
            while peer.out.waiting + len(frame) > room and len(peer.out) > 1:
                peer.out.drop_oldest()
                self._tally.lose(STALLED, f"{peer.name}, the oldest message")
        if peer.out.waiting + len(frame) > room:
            self._tally.lose(STALLED, f"{peer.name}, {peer.out.waiting} bytes wait")
            if self._limits.when_full == "Close":
                self._drop(peer, STALLED)
            return
        peer.out.put(frame)

    def _flush(self, peer: _Connection) -> None:
        try:
            while peer.out:
                peer.out.took(peer.sock.send(peer.out.next(), socket.MSG_NOSIGNAL))
        except (BlockingIOError, InterruptedError):
            pass
        except OSError as error:
            self._drop(peer, error.strerror or str(error))
            return
        writing = bool(peer.out)
        if writing != peer.writing:
            peer.writing = writing
            mask = select.EPOLLIN | (select.EPOLLOUT if writing else 0)
            self._poll.modify(peer.sock.fileno(), mask)

    def _forget(self, peer: _Connection) -> None:
        self._poll.unregister(peer.sock.fileno())
        del self._peers[peer.sock.fileno()]
        peer.sock.close()

    def _drop(self, peer: _Connection, why: str, quiet: bool = False) -> None:
        if peer.sock.fileno() not in self._peers:
            return
        waited = len(peer.out)
        self._forget(peer)
        if waited and not quiet:
            self._tally.counts.lost["connection ended"] += waited
        if not quiet:
            left = f"; {waited} messages for it are lost" if waited else ""
            self._report("INFO", f"{self._where.text}: {peer.name} is gone ({why}){left}")
        if not self._server:
            self._again_s = self._now_s + self._pause_s
