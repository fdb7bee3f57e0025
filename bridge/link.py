"""TCP over loopback without threads, timers or blocking, for virtual time.

A `Link` is one end of a connection. When both ends are in this process they know each other as `peer`, and `pump`
moves bytes until every byte that one end sent has reached the other, so what a step delivers does not depend on the
operating system's timing. The wall clock is used only as a watchdog. A link that ends reports it in `ended`; nothing
here raises because a peer disconnected.
"""

from __future__ import annotations

import itertools
import select
import socket
import time
from collections.abc import Iterable
from dataclasses import dataclass

from cratous.bridge.unread_bytes import unread_by_peer
from cratous.spec.errors import BadInput, CratousError

_CHUNK = 65536
MAX_PENDING = 16 * 1024 * 1024


class LinkStalled(CratousError):
    """No byte moved within the watchdog's time although some had been sent and had not arrived."""

    exit_code = 3


@dataclass(frozen=True)
class LinkEvent:
    """The end of a link: `eof` when the peer closed it, `error` with the system's message."""

    kind: str
    detail: str = ""


class Link:
    """One end of a TCP connection, non-blocking; `sent` and `received` count bytes."""

    def __init__(self, sock: socket.socket) -> None:
        sock.setblocking(False)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._sock = sock
        self._out = bytearray()
        self._in = bytearray()
        self.peer: Link | None = None
        self.sent = 0  # bytes accepted by `send`, including those still in our buffer
        self.received = 0
        self.ended: LinkEvent | None = None
        self.closed = False

    @property
    def alive(self) -> bool:
        """True while bytes can still be sent."""
        return not self.closed and self.ended is None

    @property
    def local(self) -> tuple[str, int]:
        """Host and port of this end."""
        host, port = self._sock.getsockname()[:2]
        return host, port

    @property
    def remote(self) -> tuple[str, int]:
        """Host and port of the other end."""
        host, port = self._sock.getpeername()[:2]
        return host, port

    @property
    def remote_name(self) -> str:
        """The other end's address as text; cached, so that it is available after the peer has gone."""
        try:
            return ":".join(map(str, self.remote))
        except OSError:
            return "a peer that is gone"

    @property
    def itself(self) -> bool:
        """True for a socket connected to itself: the system may assign a client the port that it connects to."""
        try:
            return self.local == self.remote
        except OSError:
            return False

    @property
    def waiting(self) -> int:
        """Bytes queued here that the operating system has not accepted yet."""
        return len(self._out)

    @property
    def unread(self) -> int | None:
        """Bytes delivered to the peer that its program has not read yet; None where the system does not report it."""
        return unread_by_peer(self._sock)

    def send(self, data: bytes) -> bool:
        """Queue bytes and write what the system accepts now; False if the link is dead."""
        if not self.alive:
            return False
        if len(self._out) + len(data) > MAX_PENDING:
            self._end("error", f"the peer does not read: {len(self._out)} bytes are waiting")
            return False
        self._out += data
        self.sent += len(data)
        self.flush()
        return True

    def flush(self) -> bool:
        """Write queued bytes as far as the system accepts them; True if any were written."""
        if not self._out or not self.alive:
            return False
        try:
            count = self._sock.send(self._out, socket.MSG_NOSIGNAL)
        except (BlockingIOError, InterruptedError):
            return False
        except OSError as err:
            self._end("error", err.strerror or str(err))
            return False
        del self._out[:count]
        return count > 0

    def drain(self, chunks: int | None = None) -> bool:
        """Read all that has arrived into the inbox; True if anything did, including the end of the connection.

        chunks: the most reads, so that a fast peer leaves time for the others.
        """
        moved = False
        for _ in itertools.count() if chunks is None else range(chunks):
            if not (self.alive and self.expects_more()):
                break
            try:
                data = self._sock.recv(_CHUNK)
            except (BlockingIOError, InterruptedError):
                return moved
            except OSError as err:
                self._end("error", err.strerror or str(err))
                return True
            if not data:
                self._end("eof", "closed by the peer")
                return True
            self._in += data
            self.received += len(data)
            moved = True
        return moved

    def take(self) -> bytes:
        """The bytes of the inbox, which is emptied."""
        data = bytes(self._in)
        self._in.clear()
        return data

    def expects_more(self) -> bool:
        """True if bytes may still arrive; exact when the peer is in this process."""
        if not self.alive:
            return False
        if self.peer is None or not self.peer.alive:
            return True  # unknown, or the end of the connection is still to be read
        return self.received < self.peer.sent

    def close(self) -> None:
        """Close this end; the peer sees the end of file. May be called twice."""
        if not self.closed:
            self.closed = True
            self._sock.close()

    def fileno(self) -> int:
        """The socket's file descriptor, for select and poll."""
        return self._sock.fileno()

    def poll_mask(self) -> int:
        """The poll events that `pump` has to wait for."""
        return select.POLLIN | (select.POLLOUT if self._out else 0)

    def _end(self, kind: str, detail: str) -> None:
        self.ended = LinkEvent(kind, detail)
        self.sent -= len(self._out)  # the bytes that the system did not accept will never arrive
        self._out.clear()


class Listener:
    """A listening TCP socket; port 0 lets the system choose one."""

    def __init__(self, host: str = "127.0.0.1", port: int = 0, backlog: int = 128) -> None:
        self._sock = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            self._sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self._sock.bind((host, port))
            self._sock.listen(backlog)
        except (OSError, OverflowError) as err:
            self._sock.close()
            raise BadInput(
                "cannot listen",
                where=f"{host}:{port}",
                expected="a free port",
                got=getattr(err, "strerror", None) or str(err),
            ) from None
        self._sock.setblocking(False)

    @property
    def address(self) -> tuple[str, int]:
        """Host and port on which it listens."""
        host, port = self._sock.getsockname()[:2]
        return host, port

    def accept(self) -> Link | None:
        """The next pending connection, or None; does not block."""
        try:
            sock, _ = self._sock.accept()
        except (BlockingIOError, InterruptedError, ConnectionError):
            return None
        return Link(sock)

    def wait(self, timeout_s: float) -> bool:
        """True as soon as a connection is pending, False after timeout_s [s]."""
        return bool(select.select([self._sock], [], [], timeout_s)[0])

    def fileno(self) -> int:
        """The socket's file descriptor, for select and poll."""
        return self._sock.fileno()

    def close(self) -> None:
        """Close the listening socket."""
        self._sock.close()


def connect(address: tuple[str, int], timeout_s: float = 10.0) -> Link:
    """The client end of a new connection; BadInput if none is accepted within timeout_s [s]."""
    try:
        return Link(socket.create_connection(address, timeout=timeout_s))
    except OSError as err:
        raise BadInput(
            "cannot connect",
            where=f"{address[0]}:{address[1]}",
            expected="a listening peer",
            got=err.strerror or str(err),
        ) from None


def connect_later(address: tuple[str, int]) -> Link:
    """The client end of a connection still being established; a failure is reported as the link's end."""
    host, _ = address
    sock = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_STREAM)
    sock.setblocking(False)
    link = Link(sock)
    try:
        sock.connect(address)
    except BlockingIOError:
        pass  # in progress
    except OSError as err:
        link.ended = LinkEvent("error", err.strerror or str(err))
    return link


def connect_pair(listener: Listener, timeout_s: float = 10.0) -> tuple[Link, Link]:
    """(server end, client end) of a new connection to our own listener, known to each other.

    timeout_s: limit [s]. Connections of other programs that arrive in the meantime are closed.
    """
    client = connect(listener.address, timeout_s)
    deadline = time.monotonic() + timeout_s
    while True:
        server = listener.accept()
        if server is None:
            if not listener.wait(max(0.0, deadline - time.monotonic())):
                client.close()
                raise LinkStalled(f"our own connection was not accepted in {timeout_s:g} s")
        elif server.remote == client.local:
            server.peer, client.peer = client, server
            return server, client
        else:
            server.close()


def pump(links: Iterable[Link], watchdog_s: float = 10.0) -> None:
    """Move bytes until every byte sent by one end has reached its peer in this process.

    Raises LinkStalled if nothing moves for watchdog_s [s of wall-clock time].
    """
    ends = list(links)
    while True:
        moved = False
        for link in ends:
            moved |= link.flush()
        for link in ends:
            moved |= link.drain()
        waiting = [link for link in ends if link.peer is not None and link.expects_more()]
        if not waiting:
            return
        if moved:
            continue
        poll = select.poll()
        for link in ends:
            if link.alive:
                poll.register(link.fileno(), link.poll_mask())
        if not poll.poll(watchdog_s * 1000):
            missing = sum(max(0, link.peer.sent - link.received) for link in waiting if link.peer)
            raise LinkStalled(
                f"{missing} bytes on {len(waiting)} links did not arrive in {watchdog_s:g} s"
            )
