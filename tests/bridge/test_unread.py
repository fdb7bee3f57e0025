"""The original's client dies of what it has not read in time: no end of ours lets so much wait for it."""

from __future__ import annotations

import contextlib
import socket
import time
from typing import Any

import pytest

from cratous.bridge import text_protocol as tp
from cratous.bridge.link import LinkEvent
from cratous.bridge.port import address
from cratous.bridge.text_connection import MOST_UNREAD, Bounds, Opened
from cratous.bridge.text_port import TextPort
from cratous.bridge.text_protocol.handshake import DEFAULT_SECRET
from cratous.bridge.unread_bytes import unread_by_peer

LETHAL = 65_535
"""A read of so many bytes ends the client."""
STATE = tp.OwnPosition(1.0, 37.1, -76.4, 300.0, 300.0, 22.0, 0.0, 0.0, vehicle_id=1)


def meet(port: TextPort, opened: list[Any]) -> tuple[socket.socket, int]:
    """A client of the original's, and the key of its connection."""
    sock = socket.create_connection(port.bound, timeout=60)
    opened.append(sock)
    sock.sendall(DEFAULT_SECRET.encode())
    end = time.monotonic() + 60
    while time.monotonic() < end:
        for came in port.step(100.0):
            if isinstance(came.what, Opened):
                return sock, came.key
        time.sleep(0.001)
    raise AssertionError("not met")


@pytest.fixture
def port(opened: list[Any]) -> TextPort:
    where = address("tcp://127.0.0.1:0", ("tcp",), free=True)
    one = TextPort(where, server=True, bounds=Bounds(silence_s=None), dialect=tp.Dialect.ORIGINAL)
    opened.append(one)
    return one


def test_a_client_that_is_stopped_is_sent_no_more_than_it_survives_then_cut_off_and_met_again(
    port: TextPort, opened: list[Any]
) -> None:
    sock, key = meet(port, opened)
    for _ in range(1000):
        assert port.send(key, STATE)
    assert not port.step(109.0), "it has ten seconds"
    if unread_by_peer(sock) is None:
        pytest.skip("this system does not tell what a peer has not read")
    (ended,) = port.step(110.5)
    assert isinstance(ended.what, LinkEvent)
    assert ended.what.detail.startswith("does not read: ")
    assert not port.send(key, STATE)
    got = b""
    while piece := sock.recv(LETHAL):
        got += piece
    assert len(got) in range(MOST_UNREAD // 2, LETHAL), "what it finds when it goes on"
    lines = got.removeprefix(b"ICAROUS-UxAS_LMCP").removeprefix(b"ok ").splitlines(keepends=True)
    assert set(lines) == {tp.encode(STATE, dialect=tp.Dialect.ORIGINAL)}, "whole lines"
    sock, again = meet(port, opened)
    assert again != key
    assert port.send(again, STATE)


def test_one_that_is_slow_gets_every_line(port: TextPort, opened: list[Any]) -> None:
    sock, key = meet(port, opened)
    sock.settimeout(1)
    got, line = b"", tp.encode(STATE, dialect=tp.Dialect.ORIGINAL)
    for _ in range(1000):
        assert port.send(key, STATE)
    expected = len(b"ICAROUS-UxAS_LMCP" + b"ok ") + 1000 * len(line)
    for second in range(1000):
        with contextlib.suppress(TimeoutError):
            piece = sock.recv(LETHAL)
            assert len(piece) < LETHAL
            got += piece
        assert not port.step(100.0 + second), "each time that it reads it has ten seconds more"
        if len(got) >= expected:
            break
    assert got.endswith(1000 * line)
