"""ZRE: commands as bytes, two peers that find each other, and peers that misbehave."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator
from typing import Any

import pytest
import zmq
from hypothesis import given
from hypothesis import strategies as st
from uxas_tools import free_port

from cratous.bridge import zre_wire as wire
from cratous.bridge.port import Limits
from cratous.bridge.zre import Beacons, ZreNode
from cratous.bridge.zre_beacon import interface
from cratous.bridge.zre_peer import Event
from cratous.spec.errors import BadInput

SHORT = st.text(max_size=50)
COMMANDS = st.one_of(
    st.builds(
        wire.Command,
        st.just(wire.HELLO),
        st.integers(0, 65535),
        endpoint=SHORT,
        groups=st.lists(SHORT, max_size=4).map(tuple),
        status=st.integers(0, 255),
        name=SHORT,
        headers=st.dictionaries(SHORT, SHORT, max_size=4),
    ),
    st.builds(wire.Command, st.just(wire.SHOUT), st.integers(0, 65535), group=SHORT),
    st.builds(
        wire.Command,
        st.sampled_from([wire.JOIN, wire.LEAVE]),
        st.integers(0, 65535),
        group=SHORT,
        status=st.integers(0, 255),
    ),
    st.builds(
        wire.Command,
        st.sampled_from([wire.WHISPER, wire.PING, wire.PING_OK, wire.GOODBYE]),
        st.integers(0, 65535),
    ),
)


@given(COMMANDS)
def test_commands_come_back(command: wire.Command) -> None:
    assert wire.unpack(wire.pack(command)) == command


@given(COMMANDS, st.data())
def test_a_cut_command_is_bad_input(command: wire.Command, data: st.DataObject) -> None:
    whole = wire.pack(command)
    cut = whole[: data.draw(st.integers(0, len(whole) - 1))]
    with pytest.raises(BadInput):
        wire.unpack(cut)


@given(st.binary(max_size=200))
def test_any_bytes_are_a_command_or_bad_input(data: bytes) -> None:
    for text in (data, b"\xaa\xa1\x01\x02" + data):
        with contextlib.suppress(BadInput):
            wire.unpack(text)


def test_the_bytes_of_rfc_36() -> None:
    join = wire.pack(wire.Command(wire.JOIN, 258, group="GLOBAL", status=3))
    assert join == bytes.fromhex("aaa1 04 02 0102 06") + b"GLOBAL" + b"\x03"
    hello = wire.pack(wire.Command(wire.HELLO, 1, "tcp://h:1", ("g",), 1, "n", {"EntityID": "100"}))
    assert hello == (
        bytes.fromhex("aaa1 01 02 0001 09") + b"tcp://h:1" + bytes.fromhex("00000001 00000001")
        + b"g" + b"\x01" + b"\x01n" + bytes.fromhex("00000001 08") + b"EntityID"
        + bytes.fromhex("00000003") + b"100"
    )  # fmt: skip
    assert wire.beacon(bytes(range(16)), 0xC001) == b"ZRE\x01" + bytes(range(16)) + b"\xc0\x01"
    assert wire.read_beacon(b"ZRE\x03" + bytes(18)) is None
    with pytest.raises(BadInput, match="other version"):
        wire.unpack(b"\xaa\xa1\x01\x03\x00\x01")


class Net:
    """Nodes on the loopback device with a beacon port of their own."""

    def __init__(self) -> None:
        self.context: zmq.Context[Any] = zmq.Context()
        self.port = free_port()
        self.nodes: list[ZreNode] = []
        self.events: dict[str, list[Event]] = {}
        self.reports: list[str] = []
        self.skip_s = 0.0

    def node(self, name: str, **more: Any) -> ZreNode:
        made = ZreNode(
            self.context,
            name,
            beacons=Beacons(port=self.port, interval_s=0.05),
            report=lambda _s, text: self.reports.append(text),
            **more,
        )
        self.nodes.append(made)
        self.events[name] = []
        return made

    def until(self, done: Any) -> None:
        stop = time.monotonic() + 120
        while not done():
            assert time.monotonic() < stop, (self.events, self.reports)
            for node in self.nodes:
                self.events[node.name] += node.step(time.monotonic() + self.skip_s)
            time.sleep(0.001)

    def kinds(self, name: str) -> list[str]:
        return [event.kind for event in self.events[name]]


@pytest.fixture
def net() -> Iterator[Net]:
    made = Net()
    yield made
    for node in made.nodes:
        node.close()
    made.context.destroy(linger=0)


def test_two_peers_meet_talk_and_part(net: Net) -> None:
    a, b = net.node("a", headers={"EntityID": "1"}), net.node("b")
    a.join("GLOBAL")
    net.until(lambda: net.kinds("a") == ["ENTER"] and net.kinds("b") == ["ENTER", "JOIN"])
    assert net.events["b"][0].headers == {"EntityID": "1"}
    assert b.peers() == {a.uuid: "a"}
    assert b.whisper(a.uuid, (b"one", b"two"))
    assert b.shout("GLOBAL", (b"all",)) == 1
    assert a.shout("GLOBAL", (b"nobody is in it",)) == 0
    net.until(lambda: len(net.events["a"]) == 3)
    whisper, shout = net.events["a"][1:]
    assert (whisper.kind, whisper.content, whisper.peer) == ("WHISPER", (b"one", b"two"), b.uuid)
    assert (shout.kind, shout.group, shout.content) == ("SHOUT", "GLOBAL", (b"all",))
    b.join("GLOBAL")
    a.leave("GLOBAL")
    net.until(lambda: net.kinds("a")[3:] == ["JOIN"] and net.kinds("b")[2:] == ["LEAVE"])
    net.nodes.remove(b)
    b.close()
    net.until(lambda: net.kinds("a")[-1] == "EXIT")
    assert not a.whisper(b.uuid, (b"gone",))
    assert a.counts.lost["no such peer"] == 1


def test_a_silent_peer_is_pinged_then_gone(net: Net) -> None:
    a, b = net.node("a"), net.node("b")
    net.until(lambda: net.kinds("a") == ["ENTER"] and net.kinds("b") == ["ENTER"])
    net.nodes.remove(b)  # b does nothing any more
    net.skip_s = 6.0
    a.step(time.monotonic() + net.skip_s)
    time.sleep(0.05)
    # its inbox has a PING by now; it answers as soon as it runs again
    net.nodes.append(b)
    net.until(lambda: a.due_s is not None and a.peers())
    assert "EXIT" not in net.kinds("a")
    net.nodes.remove(b)
    net.skip_s += 40.0
    net.until(lambda: net.kinds("a")[-1] == "EXIT")
    assert any("silent" in text for text in net.reports)


def stranger(net: Net, node: ZreNode, identity: bytes, *frames: bytes) -> Any:
    sock = net.context.socket(zmq.DEALER)
    sock.linger = 0
    sock.identity = identity
    sock.connect(node.endpoint)
    for frame in frames:
        sock.send(frame)
    return sock


HELLO = wire.Command(wire.HELLO, 1, "tcp://127.0.0.1:9", (), 0, "odd", {})


@pytest.mark.parametrize(
    ("frames", "reason"),
    [
        ((b"nonsense",), "not a ZRE command"),
        ((wire.pack(wire.Command(wire.PING, 1)),), "no hello yet"),
        ((b"\xaa\xa1\x01\x03\x00\x01",), "other version of ZRE"),
        ((wire.pack(wire.Command(wire.HELLO, 1, "ipc://x")),), "endpoint that cannot be used"),
        ((wire.pack(HELLO), wire.pack(wire.Command(wire.PING, 7))), "messages of a peer are lost"),
    ],
)
def test_peers_that_misbehave_are_refused_with_a_reason(
    net: Net, frames: tuple[bytes, ...], reason: str
) -> None:
    a, b = net.node("a"), net.node("b")
    sock = stranger(net, a, b"\x01" + b"S" * 16, *frames)
    net.until(lambda: a.counts.refused[reason] == 1 and b.uuid in a.peers())
    assert list(a.peers()) == [b.uuid], "the good peer is unaffected"
    sock.close()


def test_sockets_that_are_no_peers_and_peers_that_are_too_many(net: Net) -> None:
    a = net.node("a", limits=Limits(connections=1))
    sock = stranger(net, a, b"browser", b"GET / HTTP/1.1")
    net.until(lambda: a.counts.refused["not a ZRE peer"] == 1)
    net.node("b")
    net.node("c")
    net.until(lambda: a.counts.refused["too many peers"] >= 1)
    assert len(a.peers()) <= 1
    sock.close()


def test_devices() -> None:
    assert interface("lo") == ("127.0.0.1", "127.255.255.255")
    with pytest.raises(BadInput, match="no such network device"):
        interface("nowhere0", "cfg.xml:7")
