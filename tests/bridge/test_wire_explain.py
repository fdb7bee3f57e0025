"""`cratous wire explain`: captures of TCP and UDP, sessions and text, told line by line; and what is wrong with them."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import text_protocol as tp
from cratous.bridge.text_protocol.authenticated_lines import SealedClient, SealedServer
from cratous.bridge.text_protocol.captures import Heard, read
from cratous.bridge.text_protocol.datagrams import Datagrams
from cratous.bridge.text_protocol.explanation import sentence, told
from cratous.bridge.text_protocol.handshake import DEFAULT_SECRET, HELLO
from cratous.bridge.text_protocol.layouts import LAYOUTS
from cratous.services.cli import main
from cratous.spec.errors import BadInput

MODE, VELOCITY = tp.SetMode("ACTIVE", 3), tp.SetVelocity(0.0, 20.0, -1.5)
KEY = {1: b"k" * 32}
UP, DOWN = ("127.0.0.1", 40000, 5557), ("127.0.0.1", 5557, 40000)


def packet(way: tuple[str, int, int], body: bytes, number: int | None, syn: bool = False) -> bytes:
    """An Ethernet frame of TCP, or of UDP where there is no number."""
    host, source, to = way
    if number is None:
        kind, inner = 17, struct.pack(">HHHH", source, to, 8 + len(body), 0) + body
    else:
        flags = 2 if syn else 24
        kind, inner = 6, struct.pack(">HHIIBBHHH", source, to, number, 0, 80, flags, 0, 0, 0) + body
    ip = bytes(map(int, host.split(".")))
    head = struct.pack(">BBHHHBBH", 69, 0, 20 + len(inner), 0, 0, 64, kind, 0) + ip + ip
    return bytes(12) + b"\x08\x00" + head + inner


def pcap(*packets: bytes, order: str = "<") -> bytes:
    out = struct.pack(order + "IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 1)
    for k, one in enumerate(packets):
        out += struct.pack(order + "IIII", 100 + k, 500_000, len(one), len(one)) + one
    return out


def texts(data: bytes) -> list[bytes]:
    return [one.text for one in read(data, "x")]


@pytest.mark.parametrize("order", ["<", ">"])
def test_tcp_is_put_in_order_and_told_with_its_times(order: str) -> None:
    data = tp.encode(MODE) + tp.encode(VELOCITY)
    cut = packet(UP, data[10:25], 1011)
    packets = (
        packet(UP, b"", 1000, syn=True),
        packet(DOWN, HELLO, 7),
        packet(UP, data[25:], 1026),  # before those before it
        cut,
        packet(UP, data[:10], 1001),
        cut,  # again
    )
    found = list(read(pcap(*packets, order=order), "x"))
    assert found[0] == Heard(1.0, "127.0.0.1:5557 > 127.0.0.1:40000", HELLO)
    assert [h.text + b"\n" for h in found[1:]] == [tp.encode(MODE), tp.encode(VELOCITY)]
    assert {(h.at_s, h.who) for h in found[1:]} == {(4.0, "127.0.0.1:40000 > 127.0.0.1:5557")}


def test_the_secret_is_not_shown_and_lines_may_be_glued_to_it() -> None:
    data = pcap(packet(UP, DEFAULT_SECRET.encode() + tp.encode(MODE), 5))
    said = [told(text) for text in texts(data)]
    assert said[0] == (True, "ICAROUS says the secret of the handshake")
    assert said[1] == (True, "SETMOD ICAROUS takes the vehicle, epoch 3")


def test_packets_and_datagrams_of_v2_are_told_with_what_is_around_them() -> None:
    client, server = SealedClient(keys=KEY), SealedServer(keys=KEY)
    hello = server.start()
    proof = client.feed(hello)
    client.feed(server.feed(proof))
    assert client.seal is not None
    line = client.seal.wrap(tp.encode(VELOCITY), 1500)
    gram = Datagrams(1, {**KEY, 2: b"x" * 32}).wrap(tp.encode(MODE), 900)
    data = pcap(packet(UP, line, 9), packet(UP, gram, None))
    (one, two) = (told(text) for text in texts(data))
    assert one == (
        True,
        "SETVEL ICAROUS steers: 20.0 m/s on 90 deg, climbing 1.5 m/s  "
        "[packet 1 of vehicle 1 at 1500 ms, after 0 of the other end]",
    )
    assert two[1].endswith("[datagram 1 of vehicle 1 at 900 ms]")
    damaged = line.rstrip(b"\n").replace(b"north0", b"north1")
    assert told(damaged)[0] is False
    assert "DAMAGED (packet 1" in told(damaged)[1]
    assert told(hello.rstrip())[1].startswith("opening of v2")
    assert told(proof.rstrip())[1].startswith("opening of v2")
    refused = told(b"error,no key of vehicle 9 here")
    assert refused == (True, "the connection is refused: no key of vehicle 9 here")


def test_each_message_has_a_sentence_and_the_thesis_is_read_too() -> None:
    kinds = {layout.message for layout in LAYOUTS}
    said = [
        tp.SoftReset(45.0, -121.0, 300.0),
        tp.StartMission(),
        tp.RouteStart(1),
        tp.NotKnown("X"),
    ]
    assert all(sentence(one) for one in said)
    from cratous.bridge.text_protocol.explanation import _SAYS

    assert set(_SAYS) == kinds
    right, words = told(b"WAYPTtotal1,index1,lat51.433647,long-0.215516,alt100,speed100,")
    assert right
    assert words == "WAYPT  waypoint 0 (from 0) of 1: 51.433647 N, 0.215516 W, 100 m, 100.0 m/s"


def test_the_command_tells_a_session_and_counts_what_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [
        {"session": "a"},
        {"t": 0.5, "who": "ICS", "ev": "send", "fd": 5, "data": "WPRCH,id0.0,\n"},
        {"t": 0.6, "who": "C1", "ev": "write", "data": "<a secret>"},
        {"t": 0.7, "who": "C1", "ev": "write", "data": tp.encode(MODE).decode()},
        {"t": 0.8, "who": "C1", "ev": "publish", "data": "nothing on the wire"},
    ]
    file = tmp_path / "session.jsonl"
    file.write_text("\n".join(map(json.dumps, rows)))
    assert main(["wire", "explain", str(file)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "     0.500 s  ICS  WPRCH  waypoint 0 (from 0) is reached",
        "     0.700 s  C1  SETMOD ICAROUS takes the vehicle, epoch 3",
    ]
    file.write_text("> SETMOD,type_ACTIVE_,\n< WPRCH,id\x1b0,\nWPRCH,id1.0,")
    assert main(["wire", "explain", str(file), "--raw"]) == 2
    out, err = capsys.readouterr()
    assert "to UxAS  SETMOD ICAROUS takes the vehicle" in out
    assert "to ICAROUS  WRONG: column 9: byte that is not printable" in out
    assert "\x1b" not in out
    assert err == "cratous: 2 lines right, 1 wrong\n"
    file.write_text("")
    assert main(["wire", "explain", str(file)]) == 2


def test_a_capture_that_is_cut_off_or_of_another_link_is_refused() -> None:
    whole = pcap(packet(UP, tp.encode(MODE), 1))
    for end in (10, 30, len(whole) - 1):
        with pytest.raises(BadInput, match="cut off"):
            texts(whole[:end])
    with pytest.raises(BadInput, match="link type"):
        texts(whole[:20] + struct.pack("<I", 147) + whole[24:])
    with pytest.raises(BadInput, match="no JSON"):
        texts(b'{"a": 1}\n{')


@given(st.binary(max_size=200))
def test_nothing_that_comes_makes_it_fall(data: bytes) -> None:
    told(data.replace(b"\n", b""))
    for head in (b"", pcap()):
        try:
            for one in read(head + data, "x"):
                told(one.text)
        except BadInput:
            pass


def test_what_was_not_captured_is_told_and_what_follows_it_too(tmp_path, capsys) -> None:
    """At the end of a capture, and where more waits than is held."""
    lines = [tp.encode(tp.WaypointReached(k % 250)) for k in range(1500)]
    packets, number = [packet(DOWN, b"", 999, syn=True)], 1000
    for k, line in enumerate(lines):
        if k not in (3, 1498):
            packets.append(packet(DOWN, line, number))
        number += len(line)
    found = list(read(pcap(*packets), "x"))
    kept = [line for k, line in enumerate(lines) if k not in (3, 1498)]
    assert [h.text + b"\n" for h in found if not h.missing] == kept
    assert [h.missing for h in found if h.missing] == [len(lines[3]), len(lines[1498])]
    file = tmp_path / "x.pcap"
    file.write_bytes(pcap(*packets))
    assert main(["wire", "explain", str(file)]) == 2
    said = capsys.readouterr()
    assert f"MISSING: {len(lines[3])} bytes" in said.out
    assert said.err == "cratous: 1498 lines right, 2 wrong\n"


def test_a_port_that_is_used_again_begins_a_connection() -> None:
    one, two = (tp.encode(tp.WaypointReached(k)) for k in (1, 2))
    data = pcap(
        packet(DOWN, b"", 2**31, syn=True), packet(DOWN, one, 2**31 + 1),
        packet(DOWN, b"", 5, syn=True), packet(DOWN, two, 6), packet(DOWN, b"", 5, syn=True),
    )  # fmt: skip
    assert texts(data) == [one[:-1], two[:-1]]


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b'{"a":' + b"[" * 100_000, "no JSON"),
        (pcap(packet(UP, b"x" * 50, 1))[:-30], "capture cut off"),
        (
            pcap() + struct.pack("<IIII", 1, 0, 60, 104) + packet(UP, b"x" * 50, 1)[:60],
            "captured in part",
        ),
        (
            pcap(*(packet(("127.0.0.1", k, 1), b"", 1) for k in range(1, 1003))),
            "too many connections",
        ),
    ],
)
def test_what_cannot_be_told_whole_is_bad_input(data: bytes, said: str) -> None:
    with pytest.raises(BadInput, match=said):
        texts(data)


def test_a_time_that_is_no_number_of_this_machine_is_none() -> None:
    row = {"ev": "send", "who": "uxas", "t": 10**400, "data": "WPRCH,id_1,\n"}
    assert [one.at_s for one in read(json.dumps(row).encode(), "x")] == [None]


def test_what_has_no_newline_does_not_take_more_time_by_its_square() -> None:
    packets = (packet(UP, b"A" * 1400, 1 + 1400 * k) for k in range(3000))
    found = texts(pcap(*packets))
    assert b"".join(found) == b"A" * 1400 * 3000
    assert max(map(len, found)) < 70_000
