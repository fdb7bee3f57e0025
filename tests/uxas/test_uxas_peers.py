"""What was seen of the original `uxas` and of its clients, and what ours does with the same."""

from __future__ import annotations

import contextlib
import os
import struct
import tty
from pathlib import Path
from typing import Any

import pytest
import zmq
from uxas_tools import Client, free_port, process, until, write_cfg

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp, sentinel
from cratous.bridge.bytesum import byte_sum
from cratous.services.bus import Envelope
from cratous.spec.errors import BadInput

SUBSCRIBED = '<SubscribeToMessage MessageType="afrl"/>'
EXTERNAL = SUBSCRIBED + '<SubscribeToExternalMessage MessageType="afrl"/>'
PAIR = '<Bridge Type="LmcpObjectNetwork{}Bridge" Address{}="{}" Address{}="{}">{}</Bridge>'
TCP = '<Bridge Type="LmcpObjectNetworkTcpBridge" Server="TRUE" TcpAddress="tcp://127.0.0.1:{}">{}</Bridge>'


def pair(key: str) -> Any:
    return lmcp.new("KeyValuePair", Key=key)


def frame(body: Any, entity: int, service: int) -> bytes:
    data = lmcp.binary.pack(body)
    return wire.enclose(body.all_names[0], data, entity_id=entity, service_id=service).pack()


def with_length_of_pylmcp(body: Any) -> bytes:
    """A message as OpenUxAS's Python client writes it: its length leaves out the null flag."""
    data = bytearray(lmcp.binary.pack(body)[:-4])
    struct.pack_into(">I", data, 4, len(data) - 9)
    return bytes(data) + struct.pack(">I", byte_sum(data))


class ZmqClient:
    """A client of a PublishPull bridge."""

    def __init__(self, pub: int, pull: int) -> None:
        self.context: zmq.Context[Any] = zmq.Context()
        self.sub, self.push = self.context.socket(zmq.SUB), self.context.socket(zmq.PUSH)
        self.sub.subscribe(b"")
        self.sub.connect(f"tcp://127.0.0.1:{pub}")
        self.push.connect(f"tcp://127.0.0.1:{pull}")
        self.got: list[tuple[str, str, str]] = []

    def read(self) -> list[tuple[str, str, str]]:
        """(key, entity, service) of what has come."""
        while self.sub.poll(0):
            message = wire.parse(self.sub.recv())
            key = lmcp.binary.unpack(message.payload).Key
            self.got.append((key, message.entity_id, message.service_id))
        return self.got

    def close(self) -> None:
        self.context.destroy(linger=0)


def test_clients_of_a_publish_pull_bridge_hear_what_one_says_in_our_entity_s_name(
    tmp_path: Path, opened: list[Any]
) -> None:
    pub, pull = free_port(), free_port()
    addresses = f"tcp://127.0.0.1:{pub}", f"tcp://127.0.0.1:{pull}"
    text = PAIR.format("PublishPull", "PUB", addresses[0], "PULL", addresses[1], SUBSCRIBED)
    one, _ = process(write_cfg(tmp_path, text))
    clients = [ZmqClient(pub, pull) for _ in range(2)]
    opened += [one, *clients]

    def all_hear() -> bool:
        clients[0].push.send(frame(pair("hello"), 100, 9))
        return all(client.read() for client in clients)

    until(all_hear, one)
    for body, entity, service in (
        (pair("foreign"), 7, 9),
        (pair("the bridge itself"), 100, 51),
        (pair("last"), 100, 9),
    ):
        clients[0].push.send(frame(body, entity, service))
    until(lambda: all(c.read()[-1][0] == "last" for c in clients), one)
    for client in clients:
        assert {key for key, _, _ in client.got} == {"hello", "last"}
        assert [m for m in client.got if m[0] == "last"] == [("last", "100", "9")]


def test_a_subscribe_push_bridge_does_not_take_in_what_comes_back(
    tmp_path: Path, opened: list[Any]
) -> None:
    context: zmq.Context[Any] = zmq.Context()
    pub, pull = context.socket(zmq.PUB), context.socket(zmq.PULL)
    ports = [sock.bind_to_random_port("tcp://127.0.0.1") for sock in (pub, pull)]
    addresses = [f"tcp://127.0.0.1:{port}" for port in ports]
    text = PAIR.format("SubscribePush", "SUB", addresses[0], "PUSH", addresses[1], EXTERNAL)
    one, said = process(write_cfg(tmp_path, text))
    opened.append(one)
    heard: list[str] = []
    one.bus.tap(lambda e: heard.append(getattr(e.body, "Key", "")))

    def connected() -> bool:
        pub.send(frame(pair("hello"), 7, 9))
        return "hello" in heard

    until(connected, one)
    one.bus.publish(pair("ours"), "ServiceManager")
    until(lambda: pull.poll(0), one)
    pub.send(pull.recv())  # as a PublishPull bridge of the same entity gives it back
    pub.send(frame(pair("of our entity, by another"), 100, 900))
    until(lambda: "of our entity, by another" in heard, one)
    context.destroy(linger=0)
    assert heard.count("ours") == 1
    assert said.has("message of our own that came back")


def test_the_length_and_the_zones_of_pylmcp_are_let_pass_and_said(
    tmp_path: Path, opened: list[Any]
) -> None:
    port = free_port()
    one, said = process(write_cfg(tmp_path, TCP.format(port, SUBSCRIBED)))
    opened.append(one)
    client = Client(port)
    opened.append(client)
    seen: list[Any] = []
    one.bus.tap(seen.append)
    zone = bytearray(lmcp.binary.pack(lmcp.new("KeepOutZone", ZoneID=2)))
    for body, data in (
        (pair("k"), with_length_of_pylmcp(pair("k"))),
        (lmcp.new("KeepOutZone"), with_no_zone_type(zone)),
    ):
        client.raw(sentinel.frame(wire.enclose(body.all_names[0], data).pack()))
    until(lambda: len(seen) == 2, one)
    assert seen[0].body == pair("k")
    assert seen[0].raw == lmcp.binary.pack(pair("k")), "what goes on is right"
    assert seen[1].body.ZoneType.name == "Physical"
    assert lmcp.binary.unpack(seen[1].raw) == seen[1].body
    assert said.has("the length leaves out a byte")
    assert said.has("ZoneType=0 is taken for Physical")


def with_no_zone_type(data: bytearray) -> bytes:
    """The message with 0 for the type of its zone, checksum computed anew."""
    reference = lmcp.binary.pack(lmcp.new("KeepOutZone", ZoneID=2, ZoneType="Visual"))
    (at,) = [k for k in range(len(data) - 4) if data[k] != reference[k]]
    data[at] = 0
    return bytes(data[:-4]) + struct.pack(">I", byte_sum(data[:-4]))


def test_nothing_else_is_let_pass() -> None:
    good = lmcp.binary.pack(pair("key"))
    assert lmcp.binary.received(good) == (pair("key"), good, [])
    odd = with_length_of_pylmcp(pair("key"))
    assert lmcp.binary.received(odd)[1:] == (good, ["the length leaves out a byte"])
    wrong = [
        odd[:-1] + bytes([odd[-1] ^ 1]),  # the checksum is not that of the bytes
        odd[:-4] + bytes(4),  # ... and "not computed" is not enough
        odd[:-5] + odd[-4:],
        good[:4] + struct.pack(">I", len(good) - 14) + good[8:],
        good[:4] + struct.pack(">I", len(good) - 11) + good[8:],
        b"",
        odd[:8],
    ]
    for data in wrong:
        with pytest.raises(BadInput):
            lmcp.binary.received(data)
    for data in (
        odd,
        with_no_zone_type(bytearray(lmcp.binary.pack(lmcp.new("KeepOutZone", ZoneID=2)))),
    ):
        with pytest.raises(BadInput):  # only what comes over a bridge is let pass
            lmcp.binary.unpack(data)


def test_a_serial_line_gets_what_our_entity_says(tmp_path: Path, opened: list[Any]) -> None:
    master, slave = os.openpty()
    for line in (master, slave):
        tty.setraw(line)
    os.set_blocking(master, False)
    text = (
        f'<Bridge Type="LmcpObjectNetworkSerialBridge" SerialPortAddress="{os.ttyname(slave)}">'
        f"{SUBSCRIBED}</Bridge>"
    )
    one, _ = process(write_cfg(tmp_path, text))
    opened.append(one)
    stream, got = sentinel.FrameStream(), []

    def read() -> list[str]:
        with contextlib.suppress(BlockingIOError):
            got.extend(stream.feed(os.read(master, 65536)))
        return [lmcp.binary.unpack(wire.parse(p).payload).Key for p in got]

    seen: list[Any] = []
    one.bus.tap(seen.append)
    os.write(master, sentinel.frame(frame(pair("in"), 7, 9)))
    until(lambda: seen, one)
    assert (seen[0].group, seen[0].entity_id) == ("SerialBridge", 100)
    for entity in (7, 100):
        body = pair(f"of {entity}")
        topic = body.all_names[0]
        one.bus.put(Envelope(0, 0, "outside", topic, body, "", "", entity, 9))
    until(lambda: "of 100" in read(), one)
    assert read() == ["of 100"]
    one.close()
    for line in (master, slave):
        os.close(line)


def test_lines_of_message_files_that_begin_with_a_hash_are_comments(tmp_path: Path) -> None:
    """As in UxAS: before the XML, between its lines, also inside; places keep their lines."""
    text = b"""# the pair #1 <not XML>\r
<KeyValuePair Series="CMASI">
#<Key>old</Key>
 <Key>k#1</Key>
#
 <Value>#v</Value>
</KeyValuePair>
# the end"""
    (tmp_path / "pair.xml").write_bytes(text)
    entry = """<Service Type="SendMessagesService" PathToMessageFiles=".">
        <Message MessageFileName="pair.xml" SendTime_ms="10"/></Service>"""
    one, _ = process(write_cfg(tmp_path, entry), virtual=True)
    seen: list[Any] = []
    one.bus.tap(lambda e: "KeyValue" in e.topic and seen.append(e.body))
    one.run(1.0)
    assert [(p.Key, p.Value) for p in seen] == [("k#1", "#v")]
    one.close()
    # elsewhere a hash means nothing, and what is wrong is said with its line
    with pytest.raises(BadInput, match="XML"):
        lmcp.xml.read_file(tmp_path / "pair.xml")
    (tmp_path / "pair.xml").write_bytes(text.replace(b"<Value>#v", b"<Valu>#v"))
    with pytest.raises(BadInput, match=r"pair\.xml:6"):
        process(write_cfg(tmp_path, entry), virtual=True)
