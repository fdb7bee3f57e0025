"""A relay between the clients of a listening program and that program: byte for byte, with a copy for an observer.

It runs as a process of its own, so that the observer cannot slow the traffic. What the observer does not read in time
is left out of the copy and counted; the relay waits only for the two ends. When the observer has gone no new client
is accepted, and the relay ends with the last connection. Data are not interpreted, except for the opening of v2 where
nothing else may pass.
"""

from __future__ import annotations

import select
import signal
import socket
import struct
import sys
import time
from collections import deque
from contextlib import suppress

from cratous.bridge.port import is_due
from cratous.bridge.unread_bytes import unread_by_peer

RECORD = struct.Struct("!BIQI")
"""A record of the copy: kind, connection, CLOCK_MONOTONIC [ns], and the number of bytes that follow."""
OPENED, NEAR, FAR, CLOSED, LOST, BARRED = range(1, 7)
"""Kinds of records: client connected; bytes of the client; bytes of the program; connection ended; bytes left out
here; client not admitted."""
READ = 32_768
"""The most bytes forwarded beyond what the receiving program has read: the original's client crashes at twice as
much."""
MOST_COPIED = 16 << 20
MOST_CONNECTIONS = 256
CONNECTS_S, AGAIN_MS = 10.0, 20
SEALED = b"CRATOUS-2"
_END_HARD = struct.pack("ii", 1, 0)


class Copy:
    """The copy for the observer: queued up to MOST_COPIED bytes, then dropped and counted; relaying never waits for
    it."""

    def __init__(self, sock: socket.socket | None) -> None:
        self.sock = sock
        self.out = bytearray()
        self._lost = 0
        if sock is not None:
            sock.setblocking(False)

    def put(self, kind: int, connection: int, data: bytes = b"") -> None:
        """Queue one record; data beyond MOST_COPIED bytes is dropped and counted as lost."""
        if self.sock is None:
            return
        small = kind not in (NEAR, FAR)
        if not small and (self._lost or len(self.out) + len(data) > MOST_COPIED):
            self._lost += len(data)
            return
        self.out += RECORD.pack(kind, connection, time.monotonic_ns(), len(data)) + data

    def step(self) -> None:
        """Write what the watcher's socket accepts now; closes the copy if the watcher has gone."""
        if self.sock is None:
            return
        try:
            if not self.sock.recv(1, socket.MSG_DONTWAIT):
                self.close()
                return
        except BlockingIOError:
            pass
        except OSError:
            self.close()
            return
        if self._lost and len(self.out) < MOST_COPIED // 2:
            lost, self._lost = self._lost, 0
            self.put(LOST, 0, struct.pack("!Q", lost))
        while self.out:
            try:
                del self.out[: self.sock.send(self.out[: 1 << 18], socket.MSG_NOSIGNAL)]
            except BlockingIOError:
                return
            except OSError:
                self.close()
                return

    def close(self) -> None:
        """The observer has gone: discard the copy. May be called twice."""
        if self.sock is not None:
            self.sock.close()
        self.sock, self.out = None, bytearray()


class Way:
    """One direction of a relayed connection."""

    def __init__(self, source: socket.socket, sink: socket.socket, kind: int) -> None:
        self.source, self.sink, self.kind = source, sink, kind
        self.held, self.tail, self._since_s = bytearray(), b"", 0.0
        self._has_lines = False
        self.ended = self.shut = self.full = False
        self.head = b""

    @property
    def room(self) -> int:
        """Bytes that may be read now without exceeding what the receiver can hold."""
        unread = unread_by_peer(self.sink) or 0
        return max(0, READ - unread - len(self.held) - len(self.tail))

    def read(self) -> bytes:
        """The bytes that have arrived; an incomplete line is held back for AGAIN_MS [ms], because the original's
        client crashes on one. OSError if the connection is broken."""
        room = self.room
        self.full = room == 0
        if self.full or self.ended:
            return b""
        try:
            data = self.source.recv(room)
        except BlockingIOError:
            if self.tail and is_due(self._since_s + AGAIN_MS / 1000, time.monotonic()):
                self._pour_tail()
            return b""
        whole = self.tail + data
        cut = whole.rfind(b"\n") + 1
        self._has_lines |= cut > 0
        if not self._has_lines:
            cut = len(whole)
        self.held += whole[:cut]
        self.tail, self._since_s = whole[cut:], time.monotonic()
        self.ended = not data
        if self.ended or len(self.tail) > READ // 2:
            self._pour_tail()
        return data

    def _pour_tail(self) -> None:
        self.held += self.tail
        self.tail = b""

    def write(self) -> None:
        """Forward what the receiver accepts; after the last byte, the end of file."""
        while self.held:
            try:
                del self.held[: self.sink.send(self.held, socket.MSG_NOSIGNAL)]
            except BlockingIOError:
                return
        if self.ended and not self.shut:
            self.shut = True
            with suppress(OSError):
                self.sink.shutdown(socket.SHUT_WR)


class Pair:
    """A client, and the connection made on its behalf."""

    def __init__(self, number: int, near: socket.socket, far: socket.socket, plain: bool) -> None:
        self.number, self.near, self.far, self.plain = number, near, far, plain
        self.ways = (Way(far, near, FAR), Way(near, far, NEAR))
        self.connecting, self.until_s = True, time.monotonic() + CONNECTS_S
        for one in (near, far):
            one.setblocking(False)
            one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def step(self, copy: Copy, ready: set[int]) -> bool:
        """Relay bytes both ways; False if the connection is over. ready: file descriptors that `poll` reported."""
        if self.connecting and not self._connected():
            return not is_due(self.until_s, time.monotonic()) and self.near.fileno() >= 0
        try:
            for way in self.ways:
                again = way.full or way.tail or way.source.fileno() in ready
                if again and (data := way.read()):
                    if not self._may_pass(way, data):
                        copy.put(BARRED, self.number)
                        self.close(hard=True)
                        return False
                    copy.put(way.kind, self.number, data)
                way.write()
        except OSError:
            self.close(hard=True)
            return False
        return not all(way.shut for way in self.ways)

    def _connected(self) -> bool:
        if not select.select([], [self.far], [], 0)[1]:
            return False
        if self.far.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR):
            self.close(hard=True)
            return False
        self.connecting = False
        return True

    def _may_pass(self, way: Way, data: bytes) -> bool:
        if self.plain or len(way.head) >= len(SEALED):
            return True
        way.head = (way.head + data)[: len(SEALED)]
        return SEALED.startswith(way.head)

    def close(self, hard: bool = False) -> None:
        """Close both ends; hard: with a reset, as a broken connection."""
        for one in (self.near, self.far):
            if hard and one.fileno() >= 0:
                with suppress(OSError):
                    one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _END_HARD)
            one.close()


class Relay:
    """Accepts clients at a listener and relays each to the address of another program."""

    def __init__(
        self, listener: socket.socket, watcher: socket.socket, to: tuple[str, int], plain: bool
    ) -> None:
        """plain: traffic other than v2 may pass too."""
        self.listener: socket.socket | None = listener
        self.copy, self._to, self._plain = Copy(watcher), to, plain
        self.pairs: dict[int, Pair] = {}
        self._waiting: deque[socket.socket] = deque()
        self._count, self._rests = 0, False
        listener.setblocking(False)

    def run(self) -> None:
        """Relay until the observer and all connections have gone."""
        while self.copy.sock is not None or self.pairs:
            ready = self._wait()
            self._accept()
            for number, pair in list(self.pairs.items()):
                if not pair.step(self.copy, ready):
                    pair.close()
                    del self.pairs[number]
                    self.copy.put(CLOSED, number)
            self.copy.step()
            if self.copy.sock is None and self.listener is not None:
                self.listener.close()
                self.listener = None
                for one in self._waiting:
                    one.close()
                self._waiting.clear()

    def _accept(self) -> None:
        while self.listener is not None:
            try:
                near, _ = self.listener.accept()
            except BlockingIOError:
                break
            except OSError:  # no file descriptor is left: retry later
                self._rests = True
                break
            if len(self.pairs) + len(self._waiting) < MOST_CONNECTIONS:
                self._waiting.append(near)
            else:
                near.close()
        # one after the other, so that the program accepts them in order of arrival
        while self._waiting and not any(pair.connecting for pair in self.pairs.values()):
            near = self._waiting.popleft()
            try:
                pair = Pair(self._count + 1, near, self._far(), self._plain)
            except OSError:  # no file descriptor is left, or the program has gone
                near.close()
                continue
            self._count += 1
            self.pairs[self._count] = pair
            pair.far.connect_ex(self._to)
            self.copy.put(OPENED, self._count)

    def _far(self) -> socket.socket:
        family = socket.AF_INET6 if ":" in self._to[0] else socket.AF_INET
        return socket.socket(family, socket.SOCK_STREAM)

    def _wait(self) -> set[int]:
        masks: dict[int, int] = {}

        def add(sock: socket.socket | None, mask: int) -> None:
            if sock is not None and sock.fileno() >= 0:
                masks[sock.fileno()] = masks.get(sock.fileno(), 0) | mask

        timeout_ms: int | None = None
        if self._rests:
            timeout_ms, self._rests = AGAIN_MS, False
        else:
            add(self.listener, select.POLLIN)
        add(self.copy.sock, select.POLLIN | (select.POLLOUT if self.copy.out else 0))
        for pair in self.pairs.values():
            if pair.connecting:
                add(pair.far, select.POLLOUT)
                timeout_ms = timeout_ms or 1000
                continue
            for way in pair.ways:
                if way.full or way.tail:
                    timeout_ms = AGAIN_MS
                if not (way.full or way.ended):
                    add(way.source, select.POLLIN)
                if way.held:
                    add(way.sink, select.POLLOUT)
        poll = select.poll()
        for fd, mask in masks.items():
            poll.register(fd, mask)
        return {fd for fd, _ in poll.poll(timeout_ms)}


def main(words: list[str]) -> None:
    """Run the relay. words: file descriptors of listener and watcher, host, port, and `plain` or `sealed`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is meant for the observer
    listener, watcher = (socket.socket(fileno=int(word)) for word in words[:2])
    Relay(listener, watcher, (words[2], int(words[3])), words[4] == "plain").run()


if __name__ == "__main__":
    main(sys.argv[1:])
