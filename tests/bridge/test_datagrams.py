"""Datagrams of v2 between vehicles: what is believed, and what becomes of those that are forged, replayed, overtaken,
older than the window, oversize, or recorded before one of the two was started."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from bridge_tools import one_byte_changed
from hypothesis import given
from hypothesis import strategies as st
from uxas_tools import free_port

from cratous.bridge.multicast_port import MOST_READ, MulticastPort
from cratous.bridge.port import address
from cratous.bridge.text_protocol import datagrams as dg
from cratous.bridge.text_protocol.authenticated_lines import DAMAGED, FORGED
from cratous.bridge.text_protocol.keys import direct_keys_of, without_keys
from cratous.core.authority.replay_window import Window
from cratous.spec.authority.replay_window import WIDTH
from cratous.spec.errors import BadInput

KEYS = {1: b"a" * 32, 2: b"b" * 32}
LINE = b"POSTN,timegps1.0,\n"


def pair() -> tuple[dg.Datagrams, dg.Datagrams]:
    """Two vehicles that hear each other."""
    one, two = dg.Datagrams(1, KEYS), dg.Datagrams(2, KEYS)
    two.open(one.wrap(LINE, 0))
    one.open(two.wrap(LINE, 0))
    two.open(one.wrap(LINE, 0))
    return one, two


def why(found: Any) -> str:
    assert isinstance(found, dg.Refused), found
    return found.why


def test_a_vehicle_is_believed_once_it_hears_the_receiver() -> None:
    one, two = dg.Datagrams(1, KEYS), dg.Datagrams(2, KEYS)
    assert why(two.open(one.wrap(LINE, 0))) == dg.NOT_HEARD
    assert one.open(two.wrap(LINE, 5)) == dg.Said(2, 5, LINE)  # it hears: the first has come
    assert two.open(one.wrap(LINE, 6)) == dg.Said(1, 6, LINE)
    assert one.open(one.wrap(LINE, 7)) is None  # its own, which comes back


def test_what_was_recorded_before_a_start_is_not_believed_after_it() -> None:
    _one, two = pair()
    recorded = [two.wrap(LINE, k) for k in range(5)]
    again = dg.Datagrams(1, KEYS)
    assert {why(again.open(data)) for data in recorded} == {dg.NOT_HEARD}
    # though it says that it hears what was recorded, the one that flies is heard all the same
    two.open(again.wrap(LINE, 6))
    assert again.open(two.wrap(LINE, 7)) == dg.Said(2, 7, LINE)
    assert {why(again.open(data)) for data in recorded} == {dg.NOT_HEARD}
    assert two.open(again.wrap(LINE, 8)) == dg.Said(1, 8, LINE)


def test_one_that_is_started_anew_is_believed_again_and_its_former_session_is_over() -> None:
    one, two = pair()
    held_back = two.wrap(LINE, 3)
    assert one.open(two.wrap(LINE, 4)) == dg.Said(2, 4, LINE)
    late = dg.Datagrams(2, KEYS)  # started and gone, and nothing of it has arrived
    late.open(one.wrap(LINE, 4))
    never_came = late.wrap(LINE, 4)
    anew = dg.Datagrams(2, KEYS)
    anew.open(one.wrap(LINE, 5))
    assert one.open(anew.wrap(LINE, 5)) == dg.Said(2, 5, LINE)
    assert why(one.open(held_back)) == dg.OVER
    assert why(one.open(never_came)) == dg.OVER
    assert one.open(anew.wrap(LINE, 6)) == dg.Said(2, 6, LINE)


def test_overtaken_within_the_window_is_accepted_and_nothing_twice() -> None:
    one, two = pair()
    sent = [one.wrap(LINE, k) for k in range(WIDTH + 1)]
    assert two.open(sent[-1]) is not None
    assert why(two.open(sent[0])) == dg.REPEATED  # older than the window
    for data in reversed(sent[1:-1]):
        assert isinstance(two.open(data), dg.Said)
    assert {why(two.open(data)) for data in sent} == {dg.REPEATED}


def test_forged_damaged_strange_and_oversize_are_refused() -> None:
    one, two = pair()
    data = one.wrap(LINE, 9)
    assert why(two.open(data[:-1] + b"x")) == DAMAGED
    assert why(two.open(data + b"\n" + data)) == DAMAGED
    assert why(two.open(b"")) == DAMAGED
    assert why(two.open(data + b" " * dg.MOST_BYTES)) == dg.TOO_LONG
    thief = dg.Datagrams(1, {1: b"x" * 32, 2: KEYS[2]})
    assert why(two.open(thief.wrap(LINE, 9))) == FORGED
    assert why(two.open(dg.Datagrams(3, {**KEYS, 3: b"c" * 32}).wrap(LINE, 9))) == dg.STRANGER
    assert (
        why(two.open(dg.Datagrams(2, KEYS).wrap(LINE, 9))) == dg.STRANGER
    )  # its own id, by another
    assert two.open(data) == dg.Said(1, 9, LINE)


@given(st.data())
def test_a_changed_byte_is_never_believed(data: Any) -> None:
    one, two = pair()
    sent = one.wrap(LINE, 12)
    assert isinstance(two.open(data.draw(one_byte_changed(sent))), dg.Refused)


@given(st.lists(st.integers(1, 200), max_size=120))
def test_the_window_is_what_a_set_of_all_accepted_numbers_says(numbers: list[int]) -> None:
    window, accepted = Window(1000), set[int]()
    for number in numbers:
        mark = max(accepted, default=0)
        expected = number not in accepted and number > mark - WIDTH
        assert window.take(number) is expected
        if expected:
            accepted.add(number)


def test_a_number_far_ahead_is_refused() -> None:
    window = Window(10)
    assert not window.take(11)
    assert not window.take(0)
    assert window.take(10)


def test_all_that_are_heard_fit_a_datagram() -> None:
    keys = {k: bytes([k]) * 32 for k in range(1, dg.MOST_VEHICLES + 1)}
    mine = dg.Datagrams(1, keys)
    for number in range(2, dg.MOST_VEHICLES + 1):
        for _ in range(2):  # each is started twice
            other = dg.Datagrams(number, keys)
            other.open(mine.wrap(LINE, 0))
            mine.open(other.wrap(LINE, 0))
    for number in range(2, dg.MOST_VEHICLES + 1):
        mine.open(dg.Datagrams(number, keys).wrap(LINE, 0))  # and once more, unheard
    longest = b"POSTN," + b"x" * 300 + b"\n"
    assert len(mine.wrap(longest, 10**12)) <= dg.MOST_BYTES


@pytest.fixture
def ports() -> Iterator[tuple[MulticastPort, MulticastPort]]:
    where = address(f"udp://239.255.77.1:{free_port()}", ("udp",))
    pair = MulticastPort(where), MulticastPort(where)
    yield pair
    for port in pair:
        port.close()


def got(port: MulticastPort, count: int) -> list[bytes]:
    found, until_s = list[bytes](), time.monotonic() + 60
    while len(found) < count:
        assert time.monotonic() < until_s
        found += port.step()
    return found


def test_a_group_hears_what_one_says(ports: tuple[MulticastPort, MulticastPort]) -> None:
    ports[0].send(b"hello")
    assert got(ports[1], 1) == [b"hello"]
    assert got(ports[0], 1) == [b"hello"]


def test_a_flood_is_read_in_parts_and_the_genuine_one_comes_through(
    ports: tuple[MulticastPort, MulticastPort],
) -> None:
    one, two = pair()
    flood = b"CRATOUS-2D," + b"f" * 200
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        stranger.setsockopt(
            socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1")
        )
        for _ in range(MOST_READ + 50):
            stranger.sendto(flood, (ports[1].where.host, ports[1].where.port))
    ports[0].send(one.wrap(LINE, 5))
    first = got(ports[1], 1)
    assert len(first) <= MOST_READ
    answers = [two.open(data) for data in [*first, *got(ports[1], MOST_READ + 51 - len(first))]]
    assert answers.count(dg.Said(1, 5, LINE)) == 1
    assert sum(isinstance(a, dg.Refused) and a.why == DAMAGED for a in answers) == MOST_READ + 50


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "240.0.0.1"])
def test_what_is_no_group_is_refused(host: str) -> None:
    with pytest.raises(BadInput, match="no group"):
        MulticastPort(address(f"udp://{host}:5600", ("udp",)))


def test_direct_keys_are_their_own_and_are_not_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "vehicle_1.direct").write_text("ab" * 32)
    assert direct_keys_of((1,), tmp_path).by_vehicle == {1: b"\xab" * 32}
    monkeypatch.setenv("CRATOUS_DIRECT_KEY_2", "cd" * 32)
    assert direct_keys_of((2,), None).by_vehicle == {2: b"\xcd" * 32}
    (tmp_path / "vehicle_2.key").write_text("ef" * 32)  # the key of the bridge is none
    with pytest.raises(BadInput, match="no direct key") as wrong:
        direct_keys_of((1, 2), tmp_path)
    assert "ab" * 8 not in str(wrong.value)
    assert "CRATOUS_DIRECT_KEY_2" not in without_keys({"CRATOUS_DIRECT_KEY_2": "cd"})
