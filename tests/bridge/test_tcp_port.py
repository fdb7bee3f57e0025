"""Sentinel frames over TCP: pieces, sizes, nonsense, silence, floods, and those beside them."""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterator

import pytest
from uxas_tools import free_port

from cratous.bridge.port import Limits, address, often
from cratous.bridge.sentinel import FrameStream, frame
from cratous.bridge.tcp_port import FULL, HELD, LATE, NOBODY, NOISE, STALLED, TcpPort
from cratous.spec.errors import BadInput

ANY = address("tcp://127.0.0.1:0", ("tcp",), free=True)
SMALL = Limits(payload_bytes=100_000, waiting_bytes=200_000, frame_s=5.0, held_bytes=500_000)


class Reports(list):
    def __call__(self, severity: str, text: str) -> None:
        self.append((severity, text))

    def has(self, text: str) -> bool:
        return any(text in line for _, line in self)


class Server:
    """A port with a clock of its own, so that time limits cost no time."""

    def __init__(self, limits: Limits = SMALL) -> None:
        self.reports = Reports()
        self.port = TcpPort(ANY, server=True, limits=limits, report=self.reports)
        self.now_s = 0.0
        self.got: list[bytes] = []

    def connect(self) -> socket.socket:
        sock = socket.create_connection(self.port.bound, timeout=60)
        peers = self.port.peers
        self.until(lambda: self.port.peers > peers)
        return sock

    def step(self) -> None:
        self.got += [b"".join(i.parts) for i in self.port.step(self.now_s)]

    def until(self, done) -> None:
        end = time.monotonic() + 120
        while not done():
            assert time.monotonic() < end, (self.got[:3], self.reports[-3:], self.port.counts)
            self.step()
            time.sleep(0.0005)


@pytest.fixture
def server() -> Iterator[Server]:
    made = Server()
    yield made
    made.port.close()


def test_frames_come_whole_however_they_are_cut(server: Server) -> None:
    client = server.connect()
    big, small = bytes(60_000), b"!%!%!%!% inside +=+=+=+="
    data = frame(big) + b"garbage" + frame(small) + frame(b"last")
    for start in range(0, len(data), 4001):
        client.sendall(data[start : start + 4001])
        server.step()
    for byte in frame(b"one by one"):
        client.sendall(bytes((byte,)))
        server.step()
    server.until(lambda: len(server.got) == 4)
    assert server.got == [big, small, b"last", b"one by one"]
    assert server.port.counts.received == 4
    client.close()


def test_a_frame_that_announces_gigabytes_is_refused_and_the_next_one_arrives(
    server: Server,
) -> None:
    client, other = server.connect(), server.connect()
    client.sendall(b"+=+=+=+=1600000000#@#@#@#@LMCP" + frame(b"good"))
    other.sendall(frame(b"unaffected"))
    server.until(lambda: len(server.got) == 2)
    assert set(server.got) == {b"good", b"unaffected"}
    assert server.reports.has("1600000000")
    assert server.port.counts.refused["payload longer than the limit"] == 1


def test_a_peer_that_sends_only_heads_is_dropped_and_costs_the_others_nothing(
    server: Server,
) -> None:
    noisy, other = server.connect(), server.connect()
    noisy.setblocking(False)
    with contextlib.suppress(BlockingIOError):
        noisy.sendall(b"+=+=+=+=" * 100_000)
    server.until(lambda: server.port.peers == 1)
    assert server.port.counts.refused[NOISE] == 1
    other.sendall(frame(b"unaffected"))
    server.until(lambda: server.got == [b"unaffected"])


def test_a_connection_that_never_finishes_a_frame_is_dropped(server: Server) -> None:
    slow, other = server.connect(), server.connect()
    for _ in range(3):
        slow.sendall(b"+=+=+=+=90000#@#@#@#@abc")
        server.until(lambda: server.port.due_s is not None)
        server.now_s += 5.0
        server.step()
    assert server.port.counts.refused[LATE] == 3
    assert server.port.peers == 1
    other.sendall(frame(b"unaffected"))
    server.until(lambda: server.got == [b"unaffected"])
    assert server.reports.has(LATE)
    assert slow.recv(10) == b""


def test_a_trickle_does_not_extend_the_time_of_a_frame(server: Server) -> None:
    slow = server.connect()
    slow.sendall(b"+=+=+=+=9000#@#@#@#@")
    server.until(lambda: server.port.due_s is not None)
    for _ in range(6):
        slow.sendall(b"x")
        time.sleep(0.01)
        server.now_s += 0.9
        server.step()
    assert server.port.counts.refused[LATE] == 1


def test_unfinished_frames_of_all_peers_are_bounded(server: Server) -> None:
    peers = [server.connect() for _ in range(7)]
    for peer in peers:
        peer.sendall(b"+=+=+=+=99000#@#@#@#@" + bytes(90_000))
        server.step()
    server.until(lambda: server.port.counts.refused[HELD] == 2)
    assert server.port.peers == 5, "5 of 90 kB fit into 500 kB"


def test_a_thousand_idle_connections_affect_nobody(server: Server) -> None:
    from cratous.services.uxas.process import _raise_file_limit

    _raise_file_limit()
    idle = []
    for _ in range(1000):
        idle.append(socket.create_connection(server.port.bound, timeout=60))
        server.step()
    client = server.connect()
    server.until(lambda: server.port.peers == 1001)
    client.sendall(frame(b"here"))
    server.until(lambda: server.got == [b"here"])
    server.port.send((b"to all",))
    assert client.recv(100) == frame(b"to all")
    for sock in idle:
        sock.close()
    server.until(lambda: server.port.peers == 1)


def test_one_connection_too_many_is_refused_with_a_reason() -> None:
    server = Server(Limits(connections=2))
    first, second = server.connect(), server.connect()
    third = socket.create_connection(server.port.bound, timeout=60)
    server.until(lambda: server.port.counts.refused[FULL] == 1)
    assert third.recv(1) == b""
    first.sendall(frame(b"still here"))
    server.until(lambda: server.got == [b"still here"])
    for sock in (first, second, third):
        sock.close()
    server.port.close()


@pytest.mark.parametrize("policy", ["DropNewest", "DropOldest", "Close"])
def test_a_peer_that_does_not_read_never_blocks_and_loses_by_the_policy(policy: str) -> None:
    server = Server(Limits(waiting_bytes=300_000, when_full=policy))
    slow, fast = server.connect(), server.connect()
    fast.setblocking(False)
    received = FrameStream()
    for k in range(200):
        server.port.send((b"%06d" % k + bytes(100_000),))

        def read(count: int = k + 1) -> bool:
            with contextlib.suppress(BlockingIOError):
                received.feed(fast.recv(1 << 20))
            return received.frames == count

        server.until(read)
    lost = server.port.counts.lost
    assert received.frames == 200, "the one that reads gets all"
    assert lost[STALLED] > 0
    assert server.reports.has(STALLED)
    assert server.port.waiting <= 300_000
    if policy == "Close":
        assert server.port.peers == 1
        return
    stream, numbers = FrameStream(), []
    slow.settimeout(0.2)
    end = time.monotonic() + 60
    while True:
        server.step()
        try:
            numbers += [int(p[:6]) for p in stream.feed(slow.recv(1 << 20))]
        except TimeoutError:  # all is there, and nothing comes after it
            if len(numbers) + lost[STALLED] >= 200 or time.monotonic() > end:
                break
    assert len(numbers) + lost[STALLED] == 200, "what is lost is counted, frames stay whole"
    assert (numbers[-1] == 199) == (policy == "DropOldest")
    assert numbers == sorted(numbers)
    server.port.close()


def test_a_frame_longer_than_the_room_still_goes_to_one_who_reads() -> None:
    server = Server(Limits(waiting_bytes=2000))
    client = server.connect()
    server.port.send((bytes(100_000),))
    data = b""
    while len(data) < 100_000:
        server.step()
        data += client.recv(1 << 20)
    assert server.port.counts.lost == {}
    server.port.send((bytes(17 * 1024 * 1024),))
    assert server.port.counts.lost["message longer than the limit"] == 1
    server.port.close()


def test_what_is_sent_together_is_read_together(server: Server) -> None:
    client = server.connect()
    whole = frame(b"one") + frame(b"two") + frame(b"three")
    server.port.send_together([b"one", b"two", b"three"])
    assert client.recv(100_000) == whole, "in one piece"
    assert server.port.counts.sent == 3
    server.port.send_together([b"one", bytes(SMALL.payload_bytes + 1)])
    assert server.port.counts.lost["message longer than the limit"] == 1
    server.port.send((b"last",))
    assert client.recv(100_000) == frame(b"last"), "all or none"
    client.close()


def test_a_client_waits_for_its_server_and_comes_again() -> None:
    reports = Reports()
    place = "127.0.0.1", free_port()
    port = TcpPort(address(f"tcp://127.0.0.1:{place[1]}", ("tcp",)), server=False, report=reports)
    port.send((b"nobody there",))
    assert port.counts.lost[NOBODY] == 1
    now_s, got = 0.0, []
    for round_ in range(2):
        listener = socket.create_server(place)
        end = time.monotonic() + 120
        while not port.peers:
            assert time.monotonic() < end
            now_s += 0.5
            got += port.step(now_s)
            time.sleep(0.001)
        peer, _ = listener.accept()
        peer.sendall(frame(b"round %d" % round_))
        while len(got) <= round_:
            assert time.monotonic() < end
            got += port.step(now_s)
        port.send((b"answer",))
        assert peer.recv(100) == frame(b"answer")
        peer.close()
        listener.close()
        while port.peers:
            assert time.monotonic() < end
            port.step(now_s)
    assert [b"".join(i.parts) for i in got] == [b"round 0", b"round 1"]
    assert reports.has("connected")
    port.close()


def test_a_port_that_is_taken_is_bad_input(server: Server) -> None:
    host, number = server.port.bound
    with pytest.raises(BadInput, match="cannot listen"):
        TcpPort(address(f"tcp://{host}:{number}", ("tcp",)), server=True)


@pytest.mark.parametrize(
    "text",
    ["", "tcp://", "tcp://host", "tcp://host:0", "tcp://host:70000", "udp://h:1", "tcp://a b:1"],
)
def test_addresses_that_are_none(text: str) -> None:
    with pytest.raises(BadInput, match="not an address"):
        address(text, ("tcp",), where="cfg.xml:3", item="TcpAddress")


def test_addresses() -> None:
    assert address("tcp://*:9999", ("tcp",)).everywhere
    assert address("tcp://[::1]:80", ("tcp",)).host == "::1"
    assert address("ipc:///run/user/x", ("tcp", "ipc")).host == "/run/user/x"
    assert [n for n in range(1, 20) if often(n)] == [1, 2, 4, 8, 16]
