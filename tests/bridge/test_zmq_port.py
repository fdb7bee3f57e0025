"""Messages over ZeroMQ and UDP: pairs, slow readers, keys, limits; and over a serial line."""

from __future__ import annotations

import os
import pty
import time
import tty
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import zmq

from cratous.bridge.port import Limits, address
from cratous.bridge.sentinel import FrameStream, frame
from cratous.bridge.serial_port import GONE, LATE, SerialPort
from cratous.bridge.udp_port import UdpPort
from cratous.bridge.zmq_curve import Curve, Doorkeeper, make_keys
from cratous.bridge.zmq_port import SLOW, STALLED, End, ZmqPort
from cratous.spec.errors import BadInput

SCHEMES = ("tcp", "ipc", "inproc")


def end(kind: str, text: str, bind: bool, *prefixes: str) -> End:
    return End(kind, address(text, SCHEMES, free=True), bind, prefixes)


class Reports(list):
    def __call__(self, severity: str, text: str) -> None:
        self.append((severity, text))

    def has(self, text: str) -> bool:
        return any(text in line for _, line in self)


def until(done, *ports, limit_s: float = 60.0):
    """Step the ports until `done`; what each has received."""
    got: list[list[tuple[bytes, ...]]] = [[] for _ in ports]
    stop = time.monotonic() + limit_s
    while not done(got):
        assert time.monotonic() < stop, got
        for mine, port in zip(got, ports, strict=True):
            mine += [i.parts for i in port.step(time.monotonic())]
        time.sleep(0.001)
    return got


@pytest.fixture
def context() -> Iterator[zmq.Context[Any]]:
    made: zmq.Context[Any] = zmq.Context()
    yield made
    made.destroy(linger=0)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_pair_of_bridges_over_each_transport(
    context: zmq.Context[Any], scheme: str, tmp_path: Path
) -> None:
    names = {
        "tcp": ("tcp://127.0.0.1:0", "tcp://127.0.0.1:0"),
        "ipc": (f"ipc://{tmp_path}/pub", f"ipc://{tmp_path}/pull"),
        "inproc": ("inproc://pub", "inproc://pull"),
    }[scheme]
    hub = ZmqPort(context, end("PUB", names[0], True), end("PULL", names[1], True))
    far = ZmqPort(
        context,
        end("PUSH", hub.bound(True), False),
        end("SUB", hub.bound(False), False, "afrl"),
    )
    far.send((b"afrl.in$..$x",))
    until(lambda got: got[0], hub, far)

    def heard(got: Any) -> bool:
        hub.send((b"uxas.no$..$x",))
        hub.send((b"afrl.out$..$x",))
        return bool(got[1])

    got = until(heard, hub, far)
    assert set(got[1]) == {(b"afrl.out$..$x",)}
    assert hub.counts.received == 1
    assert far.counts.sent == 1
    for port in (hub, far):
        port.close()
        port.close()


def test_a_slow_subscriber_alone_loses_and_it_is_counted(context: zmq.Context[Any]) -> None:
    reports = Reports()
    hub = ZmqPort(
        context,
        end("PUB", "tcp://127.0.0.1:0", True),
        None,
        limits=Limits(high_water=50),
        report=reports,
    )
    slow, fast = context.socket(zmq.SUB), context.socket(zmq.SUB)
    for sock in (slow, fast):
        sock.rcvhwm = 50
        sock.subscribe("")
        sock.connect(hub.bound(False))
        while not sock.poll(10):
            hub.send((b"are you there",))
    count, got = 3000, 0
    for k in range(count):
        hub.send((b"%d " % k + bytes(4000),))
        while got <= k and fast.poll(60_000):
            got += fast.recv()[:1] != b"a"
    assert got == count, "the one that reads gets all"
    numbers, bound = list[bytes](), hub.since_full
    while (came := slow.recv() if slow.poll(50) else b"") != b"the end":
        numbers.append(came)
        if not came:  # it has read all that was on its way, or it is slow to come
            hub.send((b"the end",))
    missing = count - sum(n[:1].isdigit() for n in numbers)
    assert hub.counts.lost[SLOW] >= 1
    assert 0 < missing <= bound < count, "the loss is bounded from above"
    assert reports.has(SLOW)
    hub.close()
    assert reports.has("unknown part")


def test_a_push_without_a_reader_queues_within_its_limit(context: zmq.Context[Any]) -> None:
    reports = Reports()
    port = ZmqPort(
        context,
        end("PUSH", "tcp://127.0.0.1:9", False),
        None,
        limits=Limits(waiting_bytes=1000, high_water=1),
        report=reports,
    )
    for k in range(100):
        port.send((b"%03d" % k + bytes(97),))
    assert port.waiting <= 1000
    assert port.counts.lost[STALLED] == 100 - port.counts.sent - port.waiting // 100
    assert reports.has(STALLED)
    port.close()


def test_a_message_of_gigabytes_ends_only_its_own_connection(context: zmq.Context[Any]) -> None:
    import socket
    import struct

    reports = Reports()
    hub = ZmqPort(context, None, end("PULL", "tcp://127.0.0.1:0", True), report=reports)
    port = int(hub.bound(True).rpartition(":")[2])
    bad = socket.create_connection(("127.0.0.1", port), timeout=60)
    # the greeting of ZMTP 3.0 with mechanism NULL, READY as PUSH, then a frame of 1.6 GB
    bad.sendall(b"\xff" + bytes(8) + b"\x7f\x03\x00" + b"NULL".ljust(20, b"\0") + bytes(32))
    ready = b"\x05READY" + b"\x0bSocket-Type" + struct.pack(">I", 4) + b"PUSH"
    bad.sendall(b"\x04" + bytes((len(ready),)) + ready)
    bad.sendall(b"\x02" + struct.pack(">Q", 1_600_000_000) + b"LMCP")
    good = context.socket(zmq.PUSH)
    good.connect(hub.bound(True))
    good.send(b"unaffected")
    got = until(lambda got: got[0] and reports.has("gone"), hub)
    assert got[0] == [(b"unaffected",)]
    bad.settimeout(60)
    while bad.recv(4096):
        pass  # the end of the connection comes
    bad.close()
    good.close()
    hub.close()


def test_messages_of_other_numbers_of_parts_are_refused(context: zmq.Context[Any]) -> None:
    hub = ZmqPort(context, None, end("PULL", "inproc://x", True))
    push = context.socket(zmq.PUSH)
    push.connect("inproc://x")
    push.send_multipart([b"a", b"b"])
    push.send(b"good")
    assert until(lambda got: got[0], hub) == [[(b"good",)]]
    assert hub.counts.refused["wrong number of parts"] == 1
    push.close()
    hub.close()


def test_an_address_that_is_taken_is_bad_input(context: zmq.Context[Any]) -> None:
    hub = ZmqPort(context, end("PUB", "tcp://127.0.0.1:0", True), None)
    with pytest.raises(BadInput, match="cannot listen"):
        ZmqPort(context, end("PUB", hub.bound(False), True), None)
    hub.close()


def test_keys_let_known_peers_in_and_nobody_else(context: zmq.Context[Any], tmp_path: Path) -> None:
    for name in ("server", "friend", "stranger"):
        make_keys(tmp_path, name)
    (tmp_path / "known").mkdir()
    (tmp_path / "friend.key").rename(tmp_path / "known" / "friend.key")
    assert (tmp_path / "server.key_secret").stat().st_mode & 0o077 == 0
    reports = Reports()
    curve = Curve(tmp_path / "server.key_secret", None, tmp_path / "known", domain="x")
    door = Doorkeeper(context)
    door.admit(curve)
    hub = ZmqPort(
        context, None, end("PULL", "tcp://127.0.0.1:0", True), curve=curve, report=reports
    )

    def peer(name: str) -> ZmqPort:
        keys = Curve(tmp_path / f"{name}.key_secret", tmp_path / "server.key")
        return ZmqPort(context, end("PUSH", hub.bound(True), False), None, curve=keys)

    stranger, friend = peer("stranger"), peer("friend")
    stranger.send((b"from a stranger",))
    friend.send((b"from a friend",))
    plain = ZmqPort(context, end("PUSH", hub.bound(True), False), None)
    plain.send((b"without a key",))

    def done(got: Any) -> bool:
        door.step()
        return (
            bool(got[0]) and reports.has("its key is not known") and reports.has("wrong protocol")
        )

    got = until(done, hub, friend, stranger, plain)
    assert got[0] == [(b"from a friend",)]
    for port in (hub, friend, stranger, plain):
        port.close()
    door.close()


def test_keys_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="cannot be read"):
        Curve(tmp_path / "none")
    public, secret = make_keys(tmp_path, "a")
    with pytest.raises(BadInput, match="no key inside"):
        Curve(public)
    with pytest.raises(BadInput, match="no such folder"):
        Curve(secret, clients=tmp_path / "nowhere")


def test_datagrams() -> None:
    reports = Reports()
    at = UdpPort(None, address("udp://127.0.0.1:0", ("udp",), free=True))
    host, number = at.bound
    to = UdpPort(address(f"udp://{host}:{number}", ("udp",)), None, report=reports)
    for text in (b"one", b"two"):
        to.send((text,))
    assert until(lambda got: len(got[0]) == 2, at) == [[(b"one",), (b"two",)]]
    to.send((bytes(70_000),))
    assert to.counts.lost["message longer than a datagram"] == 1
    assert reports.has("longer than a datagram")
    with pytest.raises(BadInput, match="cannot listen"):
        UdpPort(None, address(f"udp://{host}:{number}", ("udp",)))
    for port in (at, to):
        port.close()


class Line:
    """A pseudo-terminal whose far end the test holds."""

    def __init__(self) -> None:
        self.far, near = pty.openpty()
        tty.setraw(self.far)
        tty.setraw(near)
        os.set_blocking(self.far, False)
        self.device = os.ttyname(near)
        self.near = near

    def read(self) -> bytes:
        try:
            return os.read(self.far, 65536)
        except BlockingIOError:
            return b""


def test_frames_over_a_serial_line_both_ways() -> None:
    line, reports = Line(), Reports()
    port = SerialPort(line.device, 57600, report=reports)
    os.write(line.far, b"noise" + frame(b"one") + frame(b"tw")[:-3])
    assert until(lambda got: got[0], port) == [[(b"one",)]]
    os.write(line.far, frame(b"tw")[-3:])
    assert until(lambda got: got[0], port) == [[(b"tw",)]]
    assert reports.has("bytes outside of a frame")
    big = bytes(range(256)) * 40
    for _ in range(3):
        port.send((big,))
    stream, got = FrameStream(), []
    stop = time.monotonic() + 120
    while len(got) < 3:
        assert time.monotonic() < stop
        port.step(0.0)
        got += stream.feed(line.read())
    assert got == [big] * 3
    port.close()


def test_a_serial_line_that_is_too_slow_or_gone_loses_with_a_count() -> None:
    line, reports = Line(), Reports()
    port = SerialPort(line.device, limits=Limits(waiting_bytes=5000, frame_s=1.0), report=reports)
    for _ in range(100):
        port.send((bytes(1000),))
    assert port.counts.lost["the line is too slow"] > 50
    os.write(line.far, b"+=+=+=+=99#@#@#@#@x")
    until(lambda _: port.due_s is not None, port)
    port.step(time.monotonic() + 2.0)
    assert port.counts.refused[LATE] == 1
    os.close(line.far)
    os.close(line.near)
    until(lambda _: reports.has("the line is gone"), port)
    port.send((b"x",))
    assert port.counts.lost[GONE] >= 1
    assert port.due_s is not None
    assert port.handles() == []
    port.close()
    with pytest.raises(BadInput, match="cannot be opened"):
        SerialPort("/dev/no-such-line", where="cfg.xml:3")


def test_what_was_queued_before_the_start_is_read_when_its_sender_can_hear(
    context: zmq.Context[Any],
) -> None:
    """A client that queues a request before we are up is not answered before it listens."""
    port = ZmqPort(
        context,
        end("PUB", "tcp://127.0.0.1:0", True),
        end("PULL", "tcp://127.0.0.1:0", True),
        settle_s=0.5,
    )
    push = context.socket(zmq.PUSH)
    push.connect(port.bound(True))
    push.send(b"request")
    assert port._in.poll(60_000), "it is there"
    assert port.step(10.0) == []
    assert port.due_s == 10.5
    assert all(sock is not port._in for sock, _ in port.handles()), "or the loop would spin"
    assert port.step(10.4) == []
    assert [incoming.parts for incoming in port.step(10.5)] == [(b"request",)]
    assert port.due_s is None
    assert any(sock is port._in for sock, _ in port.handles())
    push.close(linger=0)
    port.close()
