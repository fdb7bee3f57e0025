"""Links over loopback and the bridge of one process."""

from __future__ import annotations

import random
import select
from collections.abc import Iterator

import pytest

from cratous.bridge import text_protocol as tp
from cratous.bridge.link import LinkEvent, LinkStalled, Listener, connect, connect_pair, pump
from cratous.bridge.loopback import Bridge, BridgeError, Delivered
from cratous.spec.errors import BadInput

DOWN, UP = tp.Direction.DOWN, tp.Direction.UP


def test_pump_moves_all_bytes_even_more_than_the_buffers_hold() -> None:
    listener = Listener()
    server, client = connect_pair(listener)
    big = bytes(range(256)) * 20_000  # 5 MB
    assert server.send(big)
    assert client.send(b"small")
    pump([server, client])
    assert client.take() == big
    assert server.take() == b"small"
    assert (server.sent, client.received) == (len(big), len(big))
    for end in (server, client, listener):
        end.close()


def test_end_of_file_and_errors_are_events() -> None:
    listener = Listener()
    server, client = connect_pair(listener)
    client.send(b"last words")
    pump([server, client])
    client.close()
    client.close()
    pump([server, client])
    assert server.take() == b"last words"
    assert server.ended == LinkEvent("eof", "closed by the peer")
    assert not server.send(b"to nobody")
    assert not client.send(b"from nobody")
    listener.close()


def test_sending_to_a_peer_that_is_gone_is_an_error_event() -> None:
    listener = Listener()
    server, client = connect_pair(listener)
    server.send(b"never read")
    client.close()
    for _ in range(50):
        if not server.send(b"more"):
            break
        pump([server])
    assert server.ended is not None
    listener.close()


def test_peer_that_does_not_read_cannot_fill_the_memory() -> None:
    listener = Listener()
    server, client = connect_pair(listener)
    chunk = bytes(1024 * 1024)
    assert any(not server.send(chunk) for _ in range(64))
    assert server.ended is not None
    assert "does not read" in server.ended.detail
    client.close()
    listener.close()


def test_stall_is_noticed_by_the_watchdog() -> None:
    listener = Listener()
    server, client = connect_pair(listener)
    server.sent += 1  # a byte that will never come
    with pytest.raises(LinkStalled, match="1 bytes"):
        pump([server, client], watchdog_s=0.05)
    server.close()
    client.close()
    listener.close()


def test_strangers_are_turned_away() -> None:
    listener = Listener()
    stranger = connect(listener.address)
    server, client = connect_pair(listener)
    assert server.remote == client.local
    assert select.select([stranger], [], [], 5)[0]
    stranger.drain()
    assert stranger.ended == LinkEvent("eof", "closed by the peer")
    for end in (stranger, server, client, listener):
        end.close()


def test_nobody_listens_and_port_in_use() -> None:
    listener = Listener()
    host, port = listener.address
    with pytest.raises(BadInput, match="cannot listen"):
        Listener(host, port)
    listener.close()
    with pytest.raises(BadInput, match="cannot connect"):
        connect((host, port))


# -- the bridge --------------------------------------------------------------------------------


def fly(bridge: Bridge, steps: int) -> list[list[Delivered]]:
    log = []
    for k in range(steps):
        for vehicle_id in reversed(bridge.vehicle_ids):
            bridge.to_uxas(vehicle_id, tp.Heartbeat(k, k / 2))
            bridge.to_icarous(
                vehicle_id,
                tp.OwnPosition(k / 2, 45.3 + k * 1e-9, -121.0, 700.0, 700.0, 20.0, 1.0, -0.5),
            )
            bridge.to_icarous(vehicle_id, tp.Attitude(1.0, 2.0, 3.0))
            bridge.to_uxas(vehicle_id, tp.SetMode("ACTIVE", k))
        log.append(bridge.exchange())
    return log


def test_delivery_is_sorted_and_complete() -> None:
    with Bridge([500, 400]) as bridge:
        (step,) = fly(bridge, 1)
        assert [(d.vehicle_id, d.direction, type(d.record).__name__) for d in step] == [
            (vehicle_id, direction, name)
            for vehicle_id in (400, 500)
            for direction, names in (
                (DOWN, ("OwnPosition", "Attitude")),
                (UP, ("Heartbeat", "SetMode")),
            )
            for name in names
        ]
        assert bridge.counters[DOWN].messages == 4
        assert bridge.counters[UP].messages == 4
        assert bridge.exchange() == []


@pytest.mark.parametrize("seed", range(5))
def test_segmentation_changes_nothing(seed: int) -> None:
    dice = random.Random(seed)

    def cut(data: bytes) -> Iterator[bytes]:
        while data:
            size = dice.choice((1, 2, 7, 30, 200))
            yield data[:size]
            data = data[size:]

    with Bridge([1, 2, 3]) as plain, Bridge([1, 2, 3], segmenter=cut) as pieces:
        assert fly(plain, 5) == fly(pieces, 5)
        assert plain.counters == pieces.counters


def test_cut_is_seen_once_and_the_others_go_on() -> None:
    with Bridge([1, 2]) as bridge:
        bridge.to_uxas(1, tp.Heartbeat(1, 0.5))
        bridge.cut(1)
        assert not bridge.alive(1)
        assert bridge.alive(2)
        assert not bridge.to_icarous(1, tp.Attitude(1.0, 2.0, 3.0))
        assert not bridge.to_uxas(1, tp.Heartbeat(2, 1.0))
        bridge.to_uxas(2, tp.Heartbeat(1, 0.5))
        assert bridge.exchange() == [
            Delivered(1, UP, tp.Heartbeat(1, 0.5)),
            Delivered(1, UP, LinkEvent("eof", "closed by the peer")),
            Delivered(2, UP, tp.Heartbeat(1, 0.5)),
        ]
        assert bridge.exchange() == []


def test_wrong_uses_are_refused() -> None:
    with pytest.raises(BadInput, match="twice"):
        Bridge([1, 1])
    with pytest.raises(ValueError, match="64 hexadecimal"):
        Bridge([1], secret="short")
    with Bridge([1]) as bridge:
        with pytest.raises(BadInput, match="vehicle 2"):
            bridge.to_icarous(2, tp.Attitude(1.0, 2.0, 3.0))
        with pytest.raises(BadInput, match="other direction"):
            bridge.to_icarous(1, tp.Heartbeat(1, 0.5))


def test_handshake_that_fails_leaves_nothing_open(monkeypatch: pytest.MonkeyPatch) -> None:
    from cratous.bridge import loopback

    monkeypatch.setattr(
        loopback, "ClientHandshake", lambda secret: loopback.ServerHandshake(secret)
    )
    with pytest.raises((BridgeError, LinkStalled)):
        Bridge([1], watchdog_s=0.1)


def test_no_vehicle_no_bridge() -> None:
    with Bridge([]) as bridge:
        assert bridge.exchange() == []
