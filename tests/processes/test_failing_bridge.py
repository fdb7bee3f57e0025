"""The bridge of a flight in processes over connections that fail: what goes through, and what does not."""

from __future__ import annotations

import fcntl
import socket
import struct
import termios
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress

import pytest

from cratous.bridge.faults import FailingWay
from cratous.bridge.text_protocol import Direction, Hello, SetMode, SetVelocity, encode
from cratous.bridge.text_protocol.authenticated_lines import (
    FORGED,
    REPLAYED,
    Seal,
    SealedClient,
    SealedServer,
)
from cratous.services.processes.failing_bridge import FailingBridge
from cratous.spec.mission.bridge_faults import BridgeFaults

BEAT_MS = 500
LIMIT_S = 60.0
KEYS = {1: bytes(range(32))}
VELOCITY = encode(SetVelocity(1.0, 2.0, 0.0))


class Wire:
    """UxAS and the ICAROUS of vehicle 1, with the bridge between them, after the handshake."""

    flies = True
    at_uxas: Seal
    at_icarous: Seal

    def __init__(self, bridge: FailingBridge, server: socket.socket, now_ms: int = 0) -> None:
        self.bridge, self.server, self.now_ms = bridge, server, now_ms
        self.near, self.far = self.opened()

    def opened(self) -> tuple[socket.socket, socket.socket]:
        """A new connection from end to end, or one that is refused: its far end is then not there."""
        near, far = socket.create_connection(("127.0.0.1", self.bridge.ports[1])), None
        near.settimeout(0.01)

        def answered() -> bool:
            nonlocal far
            with suppress(TimeoutError):
                far, _ = self.server.accept()
                return True
            return near.recv(1) == b""  # it is refused by its end

        self.until(answered)
        near.settimeout(LIMIT_S)
        if far is None:
            return near, near
        far.settimeout(LIMIT_S)
        server, client = SealedServer(keys=KEYS), SealedClient(keys=KEYS)
        far.sendall(server.start())
        near.sendall(client.feed(self.line(near)))
        far.sendall(server.feed(self.line(far)))
        client.feed(self.line(near))
        assert server.seal is not None
        assert client.seal is not None
        self.at_uxas, self.at_icarous = server.seal, client.seal
        return near, far

    def until(self, done: Callable[[], object]) -> None:
        """Steps of the bridge until something is so."""
        limit_s = time.monotonic() + LIMIT_S
        while True:
            self.bridge.step(self.now_ms, self.flies)
            with_limit = time.monotonic() < limit_s
            try:
                if done():
                    return
            except TimeoutError:
                pass
            assert with_limit

    def line(self, end: socket.socket) -> bytes:
        """The next line at an end."""
        found = b""
        while not found.endswith(b"\n"):
            found += self.got(end, 1)
        return found

    def got(self, end: socket.socket, count: int) -> bytes:
        """So many bytes at an end."""
        found = b""
        end.settimeout(0.01)

        def come() -> bool:
            nonlocal found
            found += end.recv(count - len(found))
            return len(found) == count

        self.until(come)
        return found

    def steps(self, now_ms: int, times: int = 20) -> None:
        """The time of the flight is that now, and what was said has come to the bridge."""
        self.now_ms = now_ms
        self._arrives((self.near, self.far))
        for _ in range(times):
            self.bridge.step(now_ms)
            time.sleep(0.001)
        inside = self.bridge._connections.get(1)
        self._arrives([] if inside is None else [source for source, *_ in inside._halves])

    def _arrives(self, ends: Iterable[socket.socket]) -> None:
        """What was sent from these ends lies at the others, but for what does not go into their buffers."""
        limit_s = time.monotonic() + 2
        while any(_on_the_way(end) for end in ends) and time.monotonic() < limit_s:
            time.sleep(0.001)

    def there(self, end: socket.socket) -> bytes:
        """What lies at an end; b"" also for one that has ended."""
        timeout_s = end.gettimeout()
        end.setblocking(False)
        try:
            return end.recv(1 << 20)
        except (BlockingIOError, ConnectionError):
            return b""
        finally:
            end.settimeout(timeout_s)


def _on_the_way(end: socket.socket) -> int:
    """Bytes that the system still holds at this end."""
    if end.fileno() < 0:
        return 0
    return int(struct.unpack("i", fcntl.ioctl(end, termios.TIOCOUTQ, bytes(4)))[0])


@contextmanager
def wire(**faults: float) -> Iterator[Wire]:
    bridge = FailingBridge(BridgeFaults(seed=3, **faults), [1], BEAT_MS)  # type: ignore[arg-type]
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(0.2)
        bridge.leads_to(server.getsockname()[1])
        one = Wire(bridge, server)
        try:
            yield one
        finally:
            bridge.close()
            one.near.close()
            one.far.close()


def test_without_faults_everything_goes_through_however_it_is_cut() -> None:
    with wire() as one:
        lines = b"SETVEL,north1.0,east2.0,down0.0,\nHBEAT,seq1.0,time0.5,\n"
        one.near.sendall(lines[:20])
        one.steps(0)
        one.near.sendall(lines[20:])
        assert one.got(one.far, len(lines)) == lines
        one.far.sendall(b"POSTN,a1.0,\n")
        assert one.got(one.near, 12) == b"POSTN,a1.0,\n"
        one.near.close()
        one.until(lambda: one.far.recv(1) == b"")


def test_lost_lines_do_not_come_and_the_handshake_does() -> None:
    with wire(loss=1.0) as one:
        one.near.sendall(b"HBEAT,seq1.0,time0.5,\n" * 50)
        one.far.sendall(b"POSTN,a1.0,\n" * 50)
        one.steps(0, 50)
        assert one.there(one.far) == one.there(one.near) == b""


def test_late_lines_come_by_the_time_of_the_flight() -> None:
    with wire(delay_ms=1000) as one:
        lines = [b"LINE%d\n" % k for k in range(100)]
        one.far.sendall(b"".join(lines))
        one.steps(0, 50)
        before = one.there(one.near)
        assert before.count(b"\n") < 50
        one.now_ms = 1000
        after = one.got(one.near, sum(map(len, lines)) - len(before))
        assert sorted((before + after).splitlines(True)) == sorted(lines)


def test_a_cut_connection_ends_and_none_is_opened_until_it_may() -> None:
    with wire(cut_ms=2000, reconnect_ms=4000) as one:
        one.steps(2000)
        one.until(lambda: one.near.recv(1) == b"")
        refused, there = one.opened()
        assert refused is there, "UxAS is not reached"
        assert refused.recv(1) == b""
        one.now_ms = 4000
        near, far = one.opened()
        near.sendall(b"LINE\n")
        assert one.got(far, 5) == b"LINE\n"
        for end in (refused, near, far):
            end.close()


def test_a_cut_from_the_beginning_lets_all_come_before_the_clock_runs() -> None:
    with wire(cut_ms=0) as one:
        assert one.far is one.near, "in flight it is cut"
        one.flies = False
        near, far = one.opened()
        assert near is not far
        one.flies = True
        near.settimeout(0.01)
        one.until(lambda: near.recv(1) == b"")
        for end in (near, far):
            end.close()


def test_who_does_not_read_for_too_long_is_cut_off() -> None:
    with wire(stops_reading_ms=1000) as one:
        one.steps(1000)
        one.far.sendall(b"POSTN,a1.0,\n" * 100)
        one.steps(1500)
        assert one.there(one.near) == b""
        one.far.settimeout(LIMIT_S)
        one.far.sendall(b"POSTN,a1.0,\n" * 6000)
        one.far.settimeout(0.01)
        one.until(lambda: one.near.recv(1) == b"")


@pytest.mark.parametrize("share", [0.5, 1.0])
def test_forged_modes_come_to_uxas_alone_which_believes_none(share: float) -> None:
    with wire(forged_modes=share) as one:
        said, lines, refused = list[bytes](), b"", list[str]()
        for now_ms in range(0, 20_001, BEAT_MS // 2):
            for end, seal in ((one.near, one.at_icarous), (one.far, one.at_uxas)):
                packet = seal.wrap(VELOCITY, now_ms)
                end.sendall(packet)
            said.append(VELOCITY)
            one.steps(now_ms, 3)
            more, wrong = one.at_uxas.feed(one.there(one.far))
            lines, refused = lines + more, [*refused, *(one.what for one in wrong)]
            down, wrong = one.at_icarous.feed(one.there(one.near))
            assert down.replace(VELOCITY, b"") == b""
            assert wrong == []
        assert lines == b"".join(said)
        assert len(refused) in (range(20, 61) if share < 1 else (80,))
        assert set(refused) == {FORGED, REPLAYED}, "recorded packets, and the forger's own"


def test_without_seals_the_same_forged_modes_would_be_there() -> None:
    """What is refused above is a mode whole and well written: it is the seal that it lacks."""
    way = FailingWay(BridgeFaults(forged_modes=1.0), 1, Direction.UP)
    lines = {way.forged() for _ in range(200)}
    modes = [SetMode(mode, epoch) for mode in ("ACTIVE", "PASSIVE") for epoch in range(6)]
    assert lines == {encode(mode) for mode in modes}


def test_whoever_connects_and_does_not_speak_v2_is_let_through_to_be_refused() -> None:
    with wire(truncation=1.0, corruption=1.0, forged_modes=1.0) as one:
        one.near.sendall(b"\n" * 50 + b"1,2\n" + encode(Hello(1)) + b"9" * 30 + b",1,1,1,\n")
        for now_ms in range(0, 5001, BEAT_MS // 2):
            one.steps(now_ms, 3)
        lines, refused = one.at_uxas.feed(one.there(one.far))
        assert lines == b""
        assert refused


@pytest.mark.parametrize("data", [b"\n", b"A\n", b"AB\n"])
def test_a_line_that_is_cut_short_is_shorter_and_an_empty_one_is_gone(data: bytes) -> None:
    for seed in range(20):
        way = FailingWay(BridgeFaults(seed=seed, truncation=1.0), 1, Direction.UP)
        way.take(data, 0)
        left = way.due(0)
        assert left == [one for one in left if data.startswith(one) and 0 < len(one) < len(data)]
        assert len(left) == (len(data) > 1)
