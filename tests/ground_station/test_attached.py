"""`cratous serve --attach`: a running system on the page, its connection lost and made again, memory bounded."""

from __future__ import annotations

import contextlib
import itertools
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from chromium_tools import browsing
from daidalus_sky import box, mission, state, zone
from ground_station_tools import ask, attaching

from cratous.bridge import envelope, lmcp, sentinel
from cratous.bridge.port import address
from cratous.services.cli import main
from cratous.services.ground_station import attached_session
from cratous.services.ground_station.attached_session import AttachedSession
from cratous.services.ground_station.bounded_rows import Bounded

LIMIT_S = 120.0


class Peer:
    """What is watched: takes one client at a time, and says what it is told to."""

    def __init__(self) -> None:
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._listener.settimeout(LIMIT_S)
        self.port = self._listener.getsockname()[1]
        self.client: Any = None

    def accept(self) -> None:
        self.client, _ = self._listener.accept()

    def say(self, *bodies: Any) -> None:
        for body in bodies:
            name = type(body).all_names[0]
            told = envelope.AddressedMessage(
                name, envelope.LMCP, name, "", "7", "1", lmcp.binary.pack(body)
            )
            self.client.sendall(sentinel.frame(told.pack()))

    def close(self) -> None:
        with contextlib.suppress(AttributeError):
            self.client.close()
        self._listener.close()


@pytest.fixture
def peer() -> Iterator[Peer]:
    with closing(Peer()) as made:
        yield made


@pytest.fixture
def session(peer: Peer) -> Iterator[AttachedSession]:
    with closing(AttachedSession(address(f"tcp://127.0.0.1:{peer.port}", ("tcp",)))) as made:
        yield made


def _until(is_so: Callable[[], Any]) -> None:
    until_s = time.monotonic() + LIMIT_S
    while not is_so():
        assert time.monotonic() < until_s
        time.sleep(0.02)


def test_what_comes_is_kept_and_told(peer: Peer, session: AttachedSession) -> None:
    begun = session.begun()
    assert (begun["tracks"], begun["authority"], begun["attached"][:6]) == ({}, None, "tcp://")
    peer.accept()
    # a zone and a plan that come before the first position wait for the frame
    peer.say(zone("KeepOutZone", 5, *box(0, 0, 100, 200)), mission(2, (0, 0), (500, 0)))
    peer.say(state(2, 0.0, 0.0, 0.0, 20.0, 0), state(1, 900.0, 300.0, 90.0, 20.0, 0))
    peer.client.sendall(b"rubbish")
    place = state(2, 0.0, 0.0, 0.0, 20.0, 0).Location
    peer.say(lmcp.new("PointSearchTask", TaskID=5, SearchLocation=place))
    peer.say(lmcp.new("RemoveTasks", TaskList=[5]))
    _until(lambda: session.begun()["tasks"] and "to_ms" in session.begun()["tasks"][0])
    assert "to_ms" not in session.begun()["zones"][0]
    peer.say(lmcp.new("RemoveZones", ZoneList=[5]))
    _until(lambda: session.begun()["zones"] and "to_ms" in session.begun()["zones"][0])
    found = session.begun()
    assert set(found["tracks"]) == {"1", "2"}
    assert found["tracks"]["1"][0][1:4] == pytest.approx([900.0, 300.0, 1000.0], abs=2.0)
    assert found["zones"][0]["kind"] == "keep_out"
    assert found["routes"][0]["vehicle"] == 2
    assert found["routes"][0]["points"][1] == pytest.approx((500.0, 0.0), abs=2.0)
    assert "KeepOutZone" in str(found["events"])
    assert found["unread"] >= 1
    assert found["verdicts"]["why_none"].startswith("a running system is watched")
    told = session.told(begun["next"])
    assert not told["again"]
    rows = [row for update in told["updates"] for row in update["tracks"].get("1", [])]
    assert rows == found["tracks"]["1"]
    assert session.told(told["next"] + 10_000)["again"]
    assert session.status["state"] == "watching"


def test_a_connection_that_is_lost_is_told_and_made_again(
    peer: Peer, session: AttachedSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(attached_session, "SILENT_MS", 200)
    peer.accept()
    peer.say(state(2, 0.0, 0.0, 0.0, 20.0, 0))
    _until(lambda: session.status["state"] == "silent")
    assert "nothing has come since" in session.status["text"]
    peer.client.close()
    _until(lambda: "the connection is lost" in str(session.begun()["events"]))
    peer.accept()
    peer.say(state(3, 100.0, 0.0, 0.0, 20.0, 0))
    _until(lambda: "3" in session.begun()["tracks"])
    texts = [event["text"] for event in session.begun()["events"]]
    assert texts.count("connected") == 2
    assert len(texts) == 3
    peer.close()
    _until(lambda: session.status["state"] == "cut off")


def test_an_error_of_ours_is_told(
    peer: Peer, session: AttachedSession, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session, "_positions", None)
    peer.accept()
    peer.say(state(2, 0.0, 0.0, 0.0, 20.0, 0))
    session._thread.join(LIMIT_S)
    assert session._failed.startswith("internal error of CRATOUS: AttributeError")


def test_where_nobody_listens_it_says_so_and_goes_on() -> None:
    with socket.socket() as deaf:
        deaf.bind(("127.0.0.1", 0))
        where = address(f"tcp://127.0.0.1:{deaf.getsockname()[1]}", ("tcp",))
        with closing(AttachedSession(where)) as session:
            _until(lambda: "not connected" in session.status["text"])
            assert session.status["state"] == "connecting"
            deaf.listen()
            _until(lambda: session.status["state"] == "watching")


def test_memory_is_bounded_and_what_is_left_out_is_told(
    peer: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    limits = {"AIRCRAFT": 2, "SHAPES": 3, "MOST_ROWS": 4, "LOOK_MS": 0, "UPDATES": 5}
    for name, most in limits.items():
        monkeypatch.setattr(attached_session, name, most)
    with closing(AttachedSession(address(f"tcp://127.0.0.1:{peer.port}", ("tcp",)))) as session:
        peer.accept()
        peer.say(*(state(k, 0.0, 10.0 * k, 0.0, 20.0, 0) for k in range(1, 6)))
        peer.say(*(zone("KeepOutZone", k, *box(0, 0, 100, 200)) for k in range(9)))
        _until(lambda: "3 states of more than 2 aircraft" in session.status["text"])
        _until(lambda: "6 of the oldest routes, zones and tasks" in session.status["text"])
        assert [one["id"] for one in session.begun()["zones"]] == [6, 7, 8]
        first = session.begun()["next"]
        assert not session.told(first)["again"]
        _until(lambda: session.told(first)["again"])  # further behind than is kept
        # more rows than are kept make the time shorter that is kept
        begun_s = time.monotonic()
        while session.begun()["window_ms"] == attached_session.WINDOW_MS:
            assert time.monotonic() < begun_s + LIMIT_S
            peer.say(state(1, 0.0, 10.0, 0.0, 20.0, 0), state(2, 0.0, 10.0, 0.0, 20.0, 0))
            time.sleep(0.1)


def test_what_is_new_of_a_thing_takes_its_place_and_the_oldest_goes() -> None:
    rows = Bounded(3, 10, lambda row: row["id"])
    for number, places in ((1, 2), (2, 2), (1, 4), (3, 2)):
        rows.append({"id": number, "points": [0] * places})
    assert [row["id"] for row in rows] == [2, 1, 3]
    assert rows.let_go == 0
    rows.append({"id": 4, "vertices": [0] * 4})
    assert [row["id"] for row in rows] == [1, 3, 4]
    rows.append({"id": 5, "points": [0] * 11})  # more than all may have
    assert list(rows) == []
    assert rows.let_go == 5
    assert rows.take_new() == []
    for _ in range(10):  # one thing again and again, and nobody asks what is new
        rows.append({"id": 6})
    assert len(rows._new) <= 3
    assert rows.take_new() == [{"id": 6}]


def test_messages_that_come_fast_are_few_updates(peer: Peer, session: AttachedSession) -> None:
    peer.accept()
    for number in range(30):
        peer.say(state(2, 10.0 * number, 0.0, 0.0, 20.0, 0))
        time.sleep(0.005)
    _until(lambda: session.status["text"].endswith("30 messages") and session.told(0)["updates"])
    ends = [update["set"]["end_ms"] for update in session.told(0)["updates"]]
    assert all(b - a >= attached_session.UPDATE_MS for a, b in itertools.pairwise(ends))


@pytest.mark.parametrize(
    "words",
    [
        [], ["--attach", "tcp://127.0.0.1"], ["--attach", "udp://127.0.0.1:5"],
        ["out", "--attach", "127.0.0.1:5"], ["--attach", "127.0.0.1:5", "--seed", "3"],
        ["--attach", "127.0.0.1:5", "--edit"],
    ],
)  # fmt: skip
def test_an_address_that_is_none_is_refused(words: list[str], capsys: Any) -> None:
    assert main(["serve", *words, "--port", "0"]) == 2
    assert capsys.readouterr().err


@pytest.mark.slow
def test_a_running_system_is_shown_while_it_runs(peer: Peer, tmp_path: Path) -> None:
    with attaching(f"127.0.0.1:{peer.port}") as port, browsing(tmp_path) as page:
        page.go(f"http://127.0.0.1:{port}/#theme=light")
        peer.accept()
        page.until("document.getElementById('live-state')?.textContent === 'silent'")
        peer.say(state(2, 0.0, 0.0, 0.0, 20.0, 0), mission(2, (0, 0), (500, 0)))
        peer.say(zone("KeepOutZone", 5, *box(0, 0, 100, 200)))
        page.until("document.querySelector('#aircraft tr[data-aircraft=\"2\"]')")
        page.until("document.getElementById('events').textContent.includes('KeepOutZone')")

        def watched() -> bool:
            """As long as something comes; a page that is looked at late has heard nothing for a while."""
            peer.say(state(2, 0.0, 0.0, 0.0, 20.0, 0))
            return page.text("live-state") == "watching"

        _until(watched)
        for name in ("fly", "stop", "live-rate-box"):
            assert page.value(f"document.getElementById('{name}').hidden")
        assert "authority not in the log" in page.text("aircraft")
        assert "a running system is watched" in page.text("verdicts-note")
        peer.client.close()
        page.until("document.getElementById('events').textContent.includes('connection is lost')")
        peer.accept()
        peer.say(state(3, 100.0, 0.0, 0.0, 20.0, 0))
        page.until("document.querySelector('#aircraft tr[data-aircraft=\"3\"]')")
        peer.close()
        page.until("document.getElementById('live-state').textContent === 'cut off'")
        assert ask(port, "/command", "POST", b"{}").status == 405
        assert page.logged == []
