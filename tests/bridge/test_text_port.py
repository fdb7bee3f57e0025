"""The text protocol over TCP between processes: peers of every kind, and what each may cost."""

from __future__ import annotations

import contextlib
import itertools
import select
import socket
import time
from typing import Any

import pytest

from cratous.bridge import text_protocol as tp
from cratous.bridge.link import LinkEvent
from cratous.bridge.port import address
from cratous.bridge.redial import Redial
from cratous.bridge.text_connection import PARTING_S, REFUSED, Bounds, Opened
from cratous.bridge.text_port import PATIENCE_S, Came, TextPort
from cratous.bridge.text_protocol.handshake import DEFAULT_SECRET
from cratous.bridge.text_protocol.keys import new_keys
from cratous.spec.errors import BadInput

HEARTBEAT = tp.encode(tp.Heartbeat(1, 0.5))


def at(port: int = 0) -> Any:
    return address(f"tcp://127.0.0.1:{port}", ("tcp",), free=True)


def server(opened: list[Any], **bounds: Any) -> TextPort:
    one = TextPort(at(), server=True, bounds=Bounds(**bounds))
    opened.append(one)
    return one


class Clock:
    """A clock that the test moves."""

    now_s = 100.0


def until(port: TextPort, clock: Clock, done: Any) -> list[Came]:
    """Everything that comes until something of it is wanted."""
    found: list[Came] = []
    end = time.monotonic() + 60.0
    while not any(done(came.what) for came in found):
        assert time.monotonic() < end, found
        found += port.step(clock.now_s)
        time.sleep(0.001)
    return found


def raw(port: TextPort, opened: list[Any], *pieces: bytes) -> socket.socket:
    """A peer that sends these bytes."""
    sock = socket.create_connection(port.bound, timeout=60)
    opened.append(sock)
    for piece in pieces:
        sock.sendall(piece)
    return sock


def ended(why: str) -> Any:
    return lambda what: isinstance(what, LinkEvent) and why in what.detail


def test_both_ends_meet_and_messages_go_both_ways(opened: list[Any]) -> None:
    one, clock = server(opened), Clock()
    other = TextPort(at(one.bound[1]), server=False)
    opened.append(other)
    key = other.dial(clock.now_s)
    found: list[Came] = []
    while not any(isinstance(came.what, Opened) for came in found):
        found += one.step(clock.now_s)
        found += other.step(clock.now_s)
    assert other.send(key, tp.SetMode("ACTIVE", 3))
    (came,) = [c for c in until(one, clock, lambda w: isinstance(w, tp.SetMode)) if c.key][-1:]
    assert came.what == tp.SetMode("ACTIVE", 3)
    assert one.send(came.key, tp.WaypointReached(4))
    assert until(other, clock, lambda w: isinstance(w, tp.WaypointReached))
    assert not one.send(came.key, tp.WaypointReached(10**9))
    assert one.counts.lost["message has no form on the wire"] == 1
    other.close()
    assert until(one, clock, lambda w: isinstance(w, LinkEvent))
    assert not one.send(came.key, tp.WaypointReached(4))


def test_the_end_of_icarous_may_be_the_one_that_listens(opened: list[Any]) -> None:
    clock = Clock()
    icarous = TextPort(at(), server=False, listens=True)
    uxas = TextPort(at(icarous.bound[1]), server=True, listens=False)
    opened += [icarous, uxas]
    assert icarous.listens
    assert not uxas.listens
    key = uxas.dial(clock.now_s)
    found: list[Came] = []
    while not any(isinstance(came.what, Opened) for came in found):
        icarous.step(clock.now_s)
        found += uxas.step(clock.now_s)
    assert uxas.send(key, tp.WaypointReached(4))
    came = until(icarous, clock, lambda w: isinstance(w, tp.WaypointReached))[-1]
    assert icarous.send(came.key, tp.SetMode("ACTIVE", 3))
    assert until(uxas, clock, lambda w: w == tp.SetMode("ACTIVE", 3))
    # one that says nothing gets nothing: UxAS's end speaks first
    with raw(icarous, opened) as silent:
        silent.settimeout(0.2)
        icarous.step(clock.now_s)
        with pytest.raises(TimeoutError):
            silent.recv(100)


def test_a_connection_is_made_again_after_pauses_and_an_end_is_said_once(opened: list[Any]) -> None:
    with socket.socket() as held:
        held.bind(("127.0.0.1", 0))  # and does not listen
        where = at(held.getsockname()[1])
        port, now_s, said = TextPort(where, server=False), 0.0, list[str]()
        opened.append(port)
        redial, attempts = Redial(port, (where,)), list[float]()
        until_s = time.monotonic() + 60
        while len(attempts) < 5:
            assert time.monotonic() < until_s
            redial.step(now_s)
            for came in port.step(now_s):
                assert isinstance(came.what, LinkEvent)
                attempts.append(now_s)
                said.append(redial.ended(came.key, came.what.detail, now_s))
            if redial.due_s is not None:
                now_s = redial.due_s
    assert said == [f"{where.text}: Connection refused", "", "", "", ""]
    assert [round(b - a, 6) for a, b in itertools.pairwise(attempts)] == [0.1, 0.2, 0.4, 0.8]


def test_a_peer_that_ends_its_lines_with_cr_lf_is_read(opened: list[Any]) -> None:
    one, clock = server(opened), Clock()
    raw(one, opened, DEFAULT_SECRET.encode(), HEARTBEAT.replace(b"\n", b"\r\n"))
    assert until(one, clock, lambda w: w == tp.Heartbeat(1, 0.5))


@pytest.mark.parametrize(
    ("pieces", "bounds", "later_s", "why"),
    [
        ((b"x" * 64,), {}, 0.0, "handshake failed"),
        ((b"c7a7",), {"handshake_s": 5.0}, 6.0, "handshake not finished in time"),
        ((DEFAULT_SECRET.encode(),), {"silence_s": 5.0}, 6.0, "silent"),
        ((DEFAULT_SECRET.encode(), b"SETMOD,\n" * 20), {"bad_lines": 10}, 0.0, "cannot be read"),
        ((DEFAULT_SECRET.encode(), HEARTBEAT * 99), {"burst_bytes": 999.0}, 0.0, "faster"),
    ],
)
def test_what_a_peer_may_cost(
    opened: list[Any], pieces: tuple[bytes, ...], bounds: dict[str, Any], later_s: float, why: str
) -> None:
    one, clock = server(opened, **bounds), Clock()
    bad = raw(one, opened, *pieces)
    good = raw(one, opened, DEFAULT_SECRET.encode())
    if later_s:
        ready, there = 1 + (pieces[0] == DEFAULT_SECRET.encode()), 0
        end = time.monotonic() + 60.0
        while there < ready or len(one._connections) < 2:
            assert time.monotonic() < end
            there += sum(isinstance(came.what, Opened) for came in one.step(clock.now_s))
        clock.now_s += later_s
        good.sendall(HEARTBEAT)
        *_, (its_end, _) = one.handles()
        assert select.select([its_end], [], [], 60)[0], "its heartbeat is there"
    assert until(one, clock, ended(why))
    # the other peer pays nothing
    good.sendall(HEARTBEAT)
    assert until(one, clock, lambda w: isinstance(w, tp.Heartbeat))
    bad.settimeout(60)
    while bad.recv(4096):
        pass


def test_an_unfinished_line_and_one_that_is_too_long_are_said(opened: list[Any]) -> None:
    one, clock = server(opened), Clock()
    sock = raw(
        one, opened, DEFAULT_SECRET.encode(), b"A" * 9000 + b"\n" + HEARTBEAT + b"SETVEL,nor"
    )
    sock.shutdown(socket.SHUT_WR)
    found = until(one, clock, lambda w: isinstance(w, LinkEvent))
    texts = [w.what for _, w in found if isinstance(w, tp.WireError)]
    assert texts == ["line too long", "message cut off"]
    assert one.counts.refused["line too long"] == 1


def test_strangers_that_say_nothing_keep_nobody_out(opened: list[Any]) -> None:
    one, clock = server(opened, connections=2), Clock()
    for _ in range(2):
        raw(one, opened)
    end = time.monotonic() + 60
    while len(one._connections) < 2:
        assert time.monotonic() < end
        one.step(clock.now_s)
    clock.now_s += PATIENCE_S
    raw(one, opened, DEFAULT_SECRET.encode())
    assert until(one, clock, lambda w: isinstance(w, Opened))


def test_a_connection_that_opens_and_ends_at_once_is_not_made_again_at_once() -> None:
    class Refusing:
        def dial(self, now_s: float, where: Any) -> int:
            return 1

    redial, now_s, said, attempts = Redial(Refusing(), (at(1),)), 0.0, list[str](), list[float]()
    for _ in range(6):
        redial.step(now_s)
        attempts.append(now_s)
        redial.opened(1, now_s)
        said.append(redial.ended(1, "another UxAS is connected", now_s))
        now_s = redial.due_s
    assert sum(map(bool, said)) == 1
    assert [round(b - a, 6) for a, b in itertools.pairwise(attempts)] == [0.1, 0.2, 0.4, 0.8, 1.6]
    redial.step(now_s)
    redial.opened(1, now_s)
    assert redial.ended(1, "another UxAS is connected", now_s + 60.0)  # it stood for a while
    assert redial.due_s == pytest.approx(now_s + 60.1)


@pytest.mark.parametrize(
    ("host", "is_here"),
    [
        ("127.0.0.1", True),
        ("127.1.2.3", True),
        ("::1", True),
        ("localhost", True),
        ("127.evil.invalid", False),
        ("localhost.example.org", False),
        ("10.0.0.1", False),
        ("*", False),
    ],
)
def test_a_name_is_of_this_machine_only_if_it_says_so(host: str, is_here: bool) -> None:
    assert at(1)._replace(host=host).loopback == is_here


def test_more_peers_than_it_takes_are_closed_and_a_taken_port_is_refused(opened: list[Any]) -> None:
    one, clock = server(opened, connections=2), Clock()
    peers = [raw(one, opened, DEFAULT_SECRET.encode()) for _ in range(3)]
    found: list[Came] = []
    while sum(isinstance(c.what, Opened) for c in found) < 2:
        found += one.step(clock.now_s)
    end = time.monotonic() + 60
    while not one.counts.refused["too many connections"]:
        assert time.monotonic() < end
        one.step(clock.now_s)
    peers[2].settimeout(60)
    with contextlib.suppress(ConnectionResetError):  # as it had sent what nobody has read
        assert peers[2].recv(100) == b""
    with pytest.raises(BadInput, match="cannot listen"):
        TextPort(at(one.bound[1]), server=True)
    one.close()
    other, nobody = TextPort(at(one.where.port or 1), server=False), Clock()
    opened.append(other)
    other.dial(nobody.now_s)
    until(other, nobody, ended("Connection refused"))


LINE = {True: tp.WaypointReached(0), False: tp.SetMode("PASSIVE")}
"""What an end says first, UxAS's or ICAROUS's."""


@pytest.mark.parametrize("speaks", [True, False])
@pytest.mark.parametrize(
    ("uxas", "icarous"),
    [("thesis", "cratous"), ("thesis", "original"), ("cratous", "thesis"), ("original", "thesis")],
)
def test_a_peer_of_another_dialect_is_refused_with_the_reason_on_both_ends(
    opened: list[Any], uxas: str, icarous: str, speaks: bool
) -> None:
    """The end that hears the other one first refuses it, and both say why. speaks: UxAS's end does."""
    clock, said = Clock(), list[str]()
    one = TextPort(
        at(),
        server=True,
        dialect=tp.Dialect(uxas),
        report=lambda _severity, text: said.append(text),
    )
    other = TextPort(
        at(one.bound[1]),
        server=False,
        dialect=tp.Dialect(icarous),
        report=lambda _severity, text: said.append(text),
    )
    opened += [one, other]
    other.dial(clock.now_s)
    came: dict[bool, list[Came]] = {True: [], False: []}
    end, asked = time.monotonic() + 60.0, False
    while not all(found and isinstance(found[-1].what, LinkEvent) for found in came.values()):
        assert time.monotonic() < end, came
        came[True] += one.step(clock.now_s)
        came[False] += other.step(clock.now_s)
        if not asked and came[True] and came[False]:
            asked = True
            sender = one if speaks else other
            for _ in range(3):
                assert sender.send(came[speaks][0].key, LINE[speaks])
    refusing = icarous if speaks else uxas
    reason = f"line of another dialect: {refusing} is spoken here"
    assert came[not speaks][-1].what == LinkEvent(REFUSED, reason)
    assert came[speaks][-1].what == LinkEvent(REFUSED, f"the other end refuses: {reason}")
    assert not any(isinstance(x.what, tp.Message) for found in came.values() for x in found)
    assert any("refused: line of another dialect" in text for text in said)


@pytest.mark.parametrize("sealed", [False, True])
def test_one_that_uxas_refuses_is_told_why_on_a_sealed_connection_too(
    opened: list[Any], sealed: bool
) -> None:
    clock, keys = Clock(), new_keys([1])
    secret = keys if sealed else DEFAULT_SECRET
    one = TextPort(at(), server=True, secret=secret)
    other = TextPort(at(one.bound[1]), server=False, secret=secret)
    opened += [one, other]
    key = other.dial(clock.now_s)
    came: dict[bool, list[Came]] = {True: [], False: []}
    end, refused = time.monotonic() + 60.0, False
    while not all(found and isinstance(found[-1].what, LinkEvent) for found in came.values()):
        assert time.monotonic() < end, came
        came[True] += one.step(clock.now_s)
        came[False] += other.step(clock.now_s)
        if not refused and came[True] and came[False]:
            refused = True
            one.refuse(came[True][0].key, "vehicle taken", "a second instance for vehicle 1")
            assert not one.send(came[True][0].key, tp.WaypointReached(4)), "nothing goes after that"
            other.send(key, tp.SetMode("ACTIVE", 1))
    reason = "a second instance for vehicle 1"
    assert came[True][-1].what == LinkEvent(REFUSED, reason)
    assert came[False][-1].what == LinkEvent(REFUSED, f"the other end refuses: {reason}")
    assert not any(isinstance(x.what, tp.SetMode) for x in came[True]), "what it says is not heard"
    assert one.counts.refused["vehicle taken"] == 1


def test_a_refused_peer_that_goes_on_costs_no_more_than_its_time(opened: list[Any]) -> None:
    one, clock = server(opened), Clock()
    peer = raw(one, opened, DEFAULT_SECRET.encode(), b"SETMOtype_PASSIVE_,\n")
    until(one, clock, lambda what: isinstance(what, tp.WireError))
    for _ in range(20):
        peer.sendall(b"HBEATseq1,time1,\n" * 100)
        assert one.step(clock.now_s) == []
    clock.now_s += PARTING_S
    (last,) = one.step(clock.now_s)
    assert isinstance(last.what, LinkEvent)
    assert last.what.kind == REFUSED
    assert one.handles() == [(one.handles()[0][0], 1)]  # the listener alone


def test_a_line_that_lost_its_comma_on_the_way_ends_no_connection(opened: list[Any]) -> None:
    one, clock = server(opened), Clock()
    peer = raw(one, opened, DEFAULT_SECRET.encode(), b"SETMOD,type_PASSIVE_,\n")
    until(one, clock, lambda what: isinstance(what, tp.SetMode))
    peer.sendall(b"HBEATseq1.0,time1.0,\n" + HEARTBEAT)
    found = until(one, clock, lambda what: isinstance(what, tp.Heartbeat))
    assert [type(came.what).__name__ for came in found] == ["WireError", "Heartbeat"]
