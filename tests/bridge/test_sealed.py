"""The dialect v2: who has the key and who has not, and what becomes of packets that are replayed, forged,
damaged, or of another connection."""

from __future__ import annotations

import contextlib
import socket
import time
import zlib
from pathlib import Path
from typing import Any

import pytest
from bridge_tools import one_byte_changed
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import text_protocol as tp
from cratous.bridge.link import LinkEvent
from cratous.bridge.port import Address
from cratous.bridge.text_connection import DEAF, Bounds, Opened
from cratous.bridge.text_port import Came, TextPort
from cratous.bridge.text_protocol.authenticated_lines import (
    DAMAGED,
    FORGED,
    MOST_UNACKNOWLEDGED,
    NAME,
    REPLAYED,
    WINDOW,
    Seal,
    SealedClient,
    SealedServer,
)
from cratous.bridge.text_protocol.handshake import DEFAULT_SECRET
from cratous.bridge.text_protocol.keys import Keys, key_of, keys_of
from cratous.spec.errors import BadInput

KEYS = Keys({1: b"a" * 32, 2: b"b" * 32})
LINE = tp.encode(tp.SetMode("ACTIVE", 3))


def at(port: int = 0) -> Address:
    return Address("tcp", "127.0.0.1", port, f"tcp://127.0.0.1:{port}")


def key(vehicle: int, other: bytes | None = None) -> Keys:
    return Keys({vehicle: other or KEYS.by_vehicle[vehicle]})


def seals(vehicle: int = 1) -> tuple[Seal, Seal]:
    """ICAROUS's end and UxAS's of an opened connection."""
    client, server = SealedClient(keys=key(vehicle).by_vehicle), SealedServer(keys=KEYS.by_vehicle)
    client.feed(server.feed(client.feed(server.start())))
    assert client.seal is not None
    assert server.seal is not None
    return client.seal, server.seal


def meet(opened: list[Any], uxas: str | Keys, icarous: str | Keys) -> tuple[Any, ...]:
    """Two ports, and all that comes until both are open or one has ended."""
    one = TextPort(at(), server=True, secret=uxas)
    other = TextPort(at(one.bound[1]), server=False, secret=icarous)
    opened += [one, other]
    found: tuple[list[Came], list[Came]] = ([], [])
    other.dial(1.0)
    until_s = time.monotonic() + 60
    while not all(any(isinstance(c.what, Opened | LinkEvent) for c in came) for came in found):
        assert time.monotonic() < until_s
        found[0].extend(one.step(1.0))
        found[1].extend(other.step(1.0))
    return one, other, *found


def ends(came: list[Came]) -> list[str]:
    return [c.what.detail for c in came if isinstance(c.what, LinkEvent)]


def wait(port: TextPort, done: Any) -> list[Came]:
    found, until_s = list[Came](), time.monotonic() + 60
    while not done(found):
        assert time.monotonic() < until_s, found
        found += port.step(1.0)
    return found


def test_both_prove_themselves_and_lines_go_both_ways(opened: list[Any]) -> None:
    one, other, up, down = meet(opened, KEYS, key(2))
    assert [c.what for c in up][1:] == [tp.Hello(2)]  # by its key, whatever it says
    assert other.send(down[0].key, tp.SetMode("ACTIVE", 3))
    found = wait(one, lambda f: any(isinstance(c.what, tp.SetMode) for c in f))
    assert found[-1].what == tp.SetMode("ACTIVE", 3)
    assert one.send(up[0].key, tp.WaypointReached(4))
    assert wait(other, lambda f: f)[-1].what == tp.WaypointReached(4)
    # what one end has is acknowledged by the next packet of it
    assert [c.seal.unacknowledged for c in other._connections.values()] == [0]
    assert [c.seal.unacknowledged for c in one._connections.values()] == [1]
    # its key is that of vehicle 2
    assert other.send(down[0].key, tp.Hello(1))
    assert "HELLO of vehicle 1 by 2's key" in ends(wait(one, ends))


@pytest.mark.parametrize(
    ("uxas", "icarous", "at_uxas", "at_icarous"),
    [
        (KEYS, key(1, b"c" * 32), "the key of vehicle 1 is another one here",
         "UxAS refuses: the key of vehicle 1 is another one here"),
        (key(1), key(2), "no key of vehicle 2 here", "UxAS refuses: no key of vehicle 2 here"),
    ],
)  # fmt: skip
def test_a_wrong_key_is_refused_with_the_reason_on_both_ends(
    opened: list[Any], uxas: Keys, icarous: Keys, at_uxas: str, at_icarous: str
) -> None:
    _, _, up, down = meet(opened, uxas, icarous)
    assert ends(up) == [f"handshake failed: {at_uxas}"]
    assert ends(down) == [f"handshake failed: {at_icarous}"]


def test_a_recorded_opening_opens_nothing() -> None:
    """Each end's nonce is new, so neither half of an opening is worth anything a second time."""
    keys = key(1).by_vehicle
    server, client = SealedServer(keys=keys), SealedClient(keys=keys)
    answer = client.feed(server.start())
    assert server.feed(answer).startswith(b"ok,")
    again = SealedServer(keys=keys)
    again.start()
    assert again.feed(answer).startswith(b"error,")
    assert again.seal is None
    server, client = SealedServer(keys=keys), SealedClient(keys=keys)
    first = server.start()
    last = server.feed(client.feed(first))
    another = SealedClient(keys=keys)
    another.feed(first)
    another.feed(last)
    assert another.failed
    assert another.seal is None


def test_its_own_proof_sent_back_proves_nothing() -> None:
    client = SealedClient(keys=key(1).by_vehicle)
    said = client.feed(NAME + b"," + b"0" * 32 + b"\n")
    client.feed(b"ok," + said.rstrip().split(b",")[-1] + b"\n")
    assert client.failed == "the other end does not have the key of vehicle 1"
    assert client.seal is None


def test_an_opening_without_an_end_is_given_up() -> None:
    server = SealedServer(keys=key(1).by_vehicle)
    server.start()
    server.feed(b"9" * 5000)
    assert server.failed == "no line of the opening of v2"


def test_another_dialect_is_refused(opened: list[Any]) -> None:
    one = TextPort(at(), server=True, secret=KEYS)
    opened.append(one)
    with socket.create_connection(one.bound, timeout=60) as sock:
        sock.sendall(DEFAULT_SECRET.encode() + b"\n")
        assert "handshake failed: another dialect than v2" in ends(wait(one, ends))
    plain = TextPort(at(), server=True)
    sealed = TextPort(at(plain.bound[1]), server=False, secret=key(1))
    opened += [plain, sealed]
    sealed.dial(1.0)
    # HELLO of the other dialect is no line: nothing is sent to it, and what it is is told at once
    (said,) = ends(wait(sealed, lambda found: (plain.step(1.0), ends(found))[1]))
    assert said.endswith("the other end does not speak v2: it begins with 'ICAROUS-UxAS_LMCP'")


@pytest.mark.parametrize("cut", [1, 5, 9, 20, 42])
def test_an_opening_that_comes_in_pieces_is_taken(cut: int) -> None:
    client, server = SealedClient(keys=key(1).by_vehicle), SealedServer(keys=KEYS.by_vehicle)
    first = server.start()
    assert client.feed(first[:cut]) == b""
    assert not client.failed
    client.feed(server.feed(client.feed(first[cut:])))
    assert client.done


def test_a_uxas_without_the_key_is_found_out() -> None:
    client, liar = SealedClient(keys=key(1).by_vehicle), SealedServer(keys={1: b"x" * 32})
    client.feed(liar.start())
    client.feed(b"ok," + b"0" * 64 + b"\n")
    assert client.failed == "the other end does not have the key of vehicle 1"
    assert client.seal is None


def test_a_replayed_packet_is_refused_counted_and_told(opened: list[Any]) -> None:
    said = list[str]()
    one = TextPort(at(), server=True, secret=KEYS, report=lambda _s, text: said.append(text))
    opened.append(one)
    with socket.create_connection(one.bound, timeout=60) as sock:
        sock.settimeout(0.05)
        client = SealedClient(keys=key(1).by_vehicle)
        until_s = time.monotonic() + 60
        while not client.done:
            assert time.monotonic() < until_s
            one.step(1.0)
            with contextlib.suppress(TimeoutError):
                sock.sendall(client.feed(sock.recv(4096)))
        assert client.seal is not None
        packet = client.seal.wrap(LINE, 5)
        sock.sendall(packet)
        sock.sendall(packet)
        found = wait(one, lambda f: any(isinstance(c.what, tp.WireError) for c in f))
    modes = [c.what for c in found if isinstance(c.what, tp.SetMode)]
    assert modes == [tp.SetMode("ACTIVE", 3)]
    assert one.counts.refused[REPLAYED] == 1
    assert any(
        "packet number that came before or is far ahead; expected a number from 2 to 1025; got 1"
        in text
        for text in said
    )


def test_packets_of_another_connection_direction_or_vehicle_are_forged() -> None:
    up, down = seals()
    for stranger in (seals()[0], seals(2)[0], seals()[1]):
        assert [w.what for w in down.feed(stranger.wrap(LINE, 0))[1]] == [FORGED]
    assert [w.what for w in down.feed(down.wrap(LINE, 0))[1]] == [FORGED]  # sent back
    assert down.feed(up.wrap(LINE, 0)) == (LINE, [])


def test_what_the_other_end_signs_and_cannot_be_is_refused() -> None:
    up, down = seals()
    assert down.feed(up.wrap(LINE, 100))[0] == LINE
    assert [w.what for w in down.feed(up.wrap(LINE, 99))[1]] == [FORGED]  # time goes back
    up.mark = 7  # nothing was sent to it
    assert [w.what for w in down.feed(up.wrap(LINE, 100))[1]] == [FORGED]
    up.mark, up.vehicle_id = 0, 2  # the key is that of vehicle 1
    assert [w.what for w in down.feed(up.wrap(LINE, 100))[1]] == [FORGED]
    up.vehicle_id, up.sent = 1, down.mark + WINDOW
    assert [w.what for w in down.feed(up.wrap(LINE, 100))[1]] == [REPLAYED]  # above the window
    up.sent = down.mark + WINDOW - 1
    assert down.feed(up.wrap(LINE, 100)) == (LINE, [])


@given(st.lists(st.integers(0, 7), max_size=40), st.integers(1, 50))
def test_in_any_order_each_packet_is_accepted_at_most_once(order: list[int], size: int) -> None:
    up, down = seals()
    lines = [tp.encode(tp.Heartbeat(k, 0.0)) for k in range(8)]
    packets = [up.wrap(line, 0) for line in lines]
    data = b"".join(packets[k] for k in order)
    got = b""
    for start in range(0, len(data), size):
        got += down.feed(data[start : start + size])[0]
    taken = got.splitlines(keepends=True)
    expected, mark = [], -1
    for k in order:
        if k > mark:
            expected.append(lines[k])
            mark = k
    assert taken == expected
    assert len(set(taken)) == len(taken)


@given(st.data())
def test_a_changed_byte_is_never_believed(data: Any) -> None:
    up, down = seals()
    packet = up.wrap(LINE, 12)
    lines, wrong = down.feed(data.draw(one_byte_changed(packet[:-1])) + packet[-1:])
    assert lines == b""
    assert {w.what for w in wrong} <= {DAMAGED, FORGED}
    assert wrong


def test_what_the_wire_changed_is_told_from_what_somebody_forged() -> None:
    up, down = seals()
    packet = up.wrap(LINE, 12)
    changed = packet[:-2] + bytes([packet[-2] ^ 1]) + packet[-1:]
    assert [w.what for w in down.feed(changed)[1]] == [DAMAGED]
    head, body = b",".join(changed.split(b",")[:4]), changed.split(b",", 6)[6].rstrip(b"\n")
    parts = changed.split(b",", 6)
    parts[4] = b"%08x" % zlib.crc32(head + b"," + body)
    assert [w.what for w in down.feed(b",".join(parts))[1]] == [FORGED]


def test_nothing_goes_before_hands_are_shaken_nor_to_an_end_that_acknowledges_nothing(
    opened: list[Any],
) -> None:
    one, _, up, _ = meet(opened, KEYS, key(2))
    connection = one._connections[up[0].key]
    assert connection.seal is not None
    connection.seal.sent = connection.seal.acknowledged + MOST_UNACKNOWLEDGED
    assert not one.send(up[0].key, tp.WaypointReached(4))
    assert DEAF in " ".join(ends(wait(one, ends)))
    stranger = TextPort(at(one.bound[1]), server=False, secret=key(1))
    opened.append(stranger)
    assert not stranger.send(stranger.dial(1.0), tp.Hello(1))


def test_keys_of_a_connection_are_not_shown() -> None:
    up, _ = seals()
    assert "_key" not in repr(up)


def test_a_packet_without_an_end_is_bounded() -> None:
    _, down = seals()
    for _ in range(10):
        down.feed(b"9" * 4000)
    assert len(down._pending) < 9000


def test_keys_come_from_files_or_the_environment_and_are_not_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "vehicle_1.key").write_text("ab" * 32 + "\n")
    assert keys_of((1,), tmp_path).by_vehicle == {1: b"\xab" * 32}
    monkeypatch.setenv("CRATOUS_BRIDGE_KEY_2", "cd" * 32)
    assert key_of(2, None) == b"\xcd" * 32
    assert "ab" not in repr(keys_of((1,), tmp_path)).replace("vehicle", "")
    assert "xab" not in repr(SealedClient(keys=keys_of((1,), tmp_path).by_vehicle))
    (tmp_path / "vehicle_2.key").write_text("hunter2")
    (tmp_path / "vehicle_3.key").write_text("ab" * 33)
    for number in (2, 3, 4):
        with pytest.raises(BadInput, match="no key of the bridge") as wrong:
            key_of(number, tmp_path)
        assert "hunter2" not in str(wrong.value)
        assert "--plain" not in str(wrong.value)  # a folder of keys was asked for
    # who asked for nothing may come from before v2
    with pytest.raises(BadInput, match=r'CRATOUS_BRIDGE_KEY_7.*--plain, and Dialect="cratous"'):
        key_of(7, None)


def test_a_thousand_strangers_open_nothing_and_cost_the_others_nothing(opened: list[Any]) -> None:
    """Each says what a peer without keys would, a made-up opening of v2, or rubbish; most stay as long as they may."""
    bounds = Bounds(connections=8)
    one = TextPort(at(), server=True, secret=KEYS, bounds=bounds)
    other = TextPort(at(one.bound[1]), server=False, secret=key(1))
    opened += [one, other]
    other.dial(1.0)
    up = list[Came]()
    down = list[Came]()
    until_s = time.monotonic() + 60
    while not (up and down):
        assert time.monotonic() < until_s
        up, down = up + one.step(1.0), down + other.step(1.0)
    (mine,) = {c.key for c in up}
    plain = DEFAULT_SECRET.encode() + tp.encode(tp.Hello(1)) + tp.encode(tp.SetMode("ACTIVE", 1))
    made_up = b"%b,1,%b,%b\n%b" % (NAME, b"0" * 32, b"1" * 64, seals()[0].wrap(LINE, 0))
    said = (plain + b"\n", made_up, bytes(range(256)), b"", b"\n" * 40)
    strangers, found, most, sent = list[socket.socket](), list[Came](), 0, 0
    for number in range(1000):
        stranger = socket.create_connection(("127.0.0.1", one.bound[1]), timeout=60)
        strangers.append(stranger)
        with contextlib.suppress(ConnectionError):
            stranger.sendall(said[number % len(said)])
        now_s = 1.0 + number / 100
        found += one.step(now_s)
        most = max(most, len(one._connections))
        if number % 50 == 0:
            sent += other.send(down[0].key, tp.SetMode("ACTIVE", number))
            other.step(now_s)
    wait(one, lambda _: found.extend(one.step(11.0)) or _heard(found) == sent)
    for stranger in strangers:
        stranger.close()
    assert sent == 20
    assert most <= bounds.connections
    lines = [came for came in found if isinstance(came.what, tp.Message)]
    assert {came.key for came in lines} == {mine}
    assert not [came for came in found if isinstance(came.what, Opened)]
    assert mine in one._connections


def _heard(found: list[Came]) -> int:
    return sum(isinstance(came.what, tp.SetMode) for came in found)
